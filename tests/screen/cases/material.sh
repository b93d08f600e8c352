# SPDX-License-Identifier: MIT
# An OBJ file without an MTL file has a material that can be edited: saving
# writes an MTL file beside it, which is read again; the OBJ file stays. Images
# beside it are listed, and one is chosen.
size=80x24
printf 'v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n' \
    >bare.obj
printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 1 1 1\n' >bare.view
cp bare.obj as_it_was.obj
start bare.obj
wait_for LIVE
keys Tab
wait_for "│>▕  ▏material          diffuse"
keys Enter Down Down
wait_for "│>▕  ▏colour     #e7e7e7"
raw_keys '#ff0000'
keys Enter
wait_for "│>▕  ▏colour     #ff0000"
keys C-s
wait_for "wrote 1 material to bare.obj.mtl"
printf '\nnewmtl material\nKd 1 0 0\n' | cmp - bare.obj.mtl ||
    die "bare.obj.mtl: $(cat bare.obj.mtl)"
cmp bare.obj as_it_was.obj
keys C-q
expect_end 0
fresh
start bare.obj
wait_for LIVE
keys Tab
wait_for "│ ▕  ▏colour     #ff0000"
keys Enter End
wait_for "│>    add image  map_Kd"
keys Enter
wait_for "found no image beside bare.obj"
mkdir maps
printf 'P6 1 1 255\n\0\377\0' >maps/green.ppm
printf 'P6 1 1 255\n\0\0\377' >blue.ppm
keys Enter
wait_for "│ map_Kd of material"
expect "│> blue.ppm"
expect "│  maps/green.ppm"
keys Down Enter
wait_for "│>▕.*▏map_Kd     on green.ppm"
wait_until eval "screen_colors | sed 's,│.*,,' | grep -q '[34]8;2;0;255;0m'"
keys Enter
wait_for "│> blue.ppm"
keys Escape
wait_for "│>▕.*▏map_Kd     on green.ppm"
# as another map: the arrows choose which
keys Down Right
wait_for "│>    add image  map_Ks"
keys u
wait_for "│>    add image  map_K"
wait_until_gone "green.ppm"
keys U
wait_for "map_Kd     on green.ppm"
keys C-s
wait_for "wrote 1 material to bare.obj.mtl"
printf '\nnewmtl material\nKd 1 1 1\nmap_Kd maps/green.ppm\n' |
    cmp - bare.obj.mtl || die "bare.obj.mtl: $(cat bare.obj.mtl)"
keys C-q
expect_end 0
