# SPDX-License-Identifier: MIT
# Files of the scene are edited while it is on the screen. The picture is a wall
# that shines: each pixel has its Ke times the image, exactly. .5 .2 0 is 188 124
# 0 in sRGB.
size=140x21
ORANGE="48;2;188;124;0"
GREEN="48;2;0;188;0"
write() # as most editors do: another file gets the name
{
    cat >"$1.new"
    mv "$1.new" "$1"
}
wall() # z of the wall
{
    printf 'mtllib wall.mtl\nusemtl w\nv -9 -9 %s\nv 9 -9 %s\nv 9 9 %s\nv -9 9 %s\n' \
        "$1" "$1" "$1" "$1"
    echo 'vt 0 0'
    echo 'f 1/1 2/1 3/1 4/1'
}
shines() # its radiance
{
    printf 'newmtl w\nKd 0 0 0\nKe %s\n%s' "$*" "${map-}"
}
flat_scene
glim -b -s 1 -o orange.png flat.obj 2>/dev/null
printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 .5 0\n' >flat.view
glim -b -s 1 -o green.png flat.obj 2>/dev/null

load() # and do not wait until the screen says something else
{
    keys l
    wait_for "loaded wall.obj"
    keys Escape
    wait_until_gone "loaded wall.obj"
}

story() # options: which backend
{
    wall 0 >wall.obj
    shines .5 .2 0 >wall.mtl
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\n' >wall.view
    start "$@" wall.obj
    wait_for "LIVE .* $machine"
    has_line "renders; self-test" && keys Escape
    wait_until_gone "renders; self-test"
    wait_for_rows 20 "$ORANGE"
    keys w # a step ahead, which is kept

    shines 0 .5 0 | write wall.mtl
    wait_for "LIVE.*  changed: l loads"
    wait_for_rows 20 "$ORANGE"
    load
    wait_for_rows 20 "$GREEN"
    wait_for "LIVE .* $machine"
    reject "changed"

    # broken: the old picture and one message, until it is mended
    shines .5 oops | write wall.mtl
    wait_for "changed: l loads"
    keys l
    wait_for "wall.mtl:3: found 'oops'"
    wait_for_rows 20 "$GREEN"
    expect "wall.mtl:3: found 'oops'"
    shines .5 .2 0 >wall.mtl # in place
    keys Escape              # takes the message away
    wait_for "changed: l loads"
    load
    wait_for_rows 20 "$ORANGE"

    # the image
    cp orange.png wall.png
    map='map_Ke wall.png
'
    shines 1 1 1 | write wall.mtl
    map=
    wait_for "changed: l loads"
    load
    wait_for_rows 20 "$ORANGE"
    cp green.png wall.png
    wait_for "changed: l loads"
    load
    wait_for_rows 20 "$GREEN"

    # the geometry: behind the camera there is only the background
    wall 9 | write wall.obj
    wait_for "changed: l loads"
    load
    wait_for_rows 0 "$GREEN"
    # the view: another background, the camera stays where it has gone
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground .5 .2 0\n' |
        write wall.view
    wait_for "changed: l loads"
    load
    wait_for_rows 20 "$ORANGE"
    keys c
    wait_for "Change wall.view?"
    keys y
    wait_for "wrote the view"
    keys Escape
    wait_until_gone "wrote the view"
    grep -q "^eye 0 [^ ]* [34]\." wall.view || die "the camera: $(cat wall.view)"
    reject "changed" # by ourselves
    # another shape of the picture: 50x100 pixels are 20 columns in 20 rows
    sed 's/^res .*/res 50 100/' wall.view | write wall.view
    wait_for "changed: l loads"
    load
    wait_for "LIVE .* spp"
    wait_for_rows 20 "$ORANGE"
    [ "$(screen_colors | sed -n 10p | grep -o "${ORANGE}m *" |
        tr -dc ' ' | wc -c)" = 20 ] || die "not laid out anew"
    keys C-q
    expect_end 0
    fresh
}

machine="filtered"
story -t 1

# at once, but not while a render of normal mode would be lost
wall 0 >wall.obj
shines .5 .2 0 >wall.mtl
start --watch -s 1000000000 wall.obj
wait_for_rows 20 "$ORANGE"
shines 0 .5 0 | write wall.mtl
wait_for "loaded wall.obj"
wait_for_rows 20 "$GREEN"
shines .5 oops | write wall.mtl
wait_for "wall.mtl:3: found 'oops'"
shines 0 .5 0 | write wall.mtl
wait_for "loaded wall.obj"
# an image that is removed, and named no more
cp orange.png wall.png
map='map_Ke wall.png
'
shines 1 1 1 | write wall.mtl
wait_for_rows 20 "$ORANGE"
map=
rm wall.png
shines .5 .2 0 | write wall.mtl
wait_for_rows 20 "$ORANGE"
shines 0 .5 0 | write wall.mtl
wait_for_rows 20 "$GREEN"
# an export that takes a while: its first part is no scene. Behind the camera
# there is only the background.
{
    wall 9 | head -n 7
    sleep 2
    reject "loading\|wall.obj:" >&2
    wait_for_rows 20 "$GREEN"
    wall 9 | tail -n +8
} >wall.obj
wait_for_rows 20 "$ORANGE"
# all files go and come back, as with git checkout
rm wall.obj wall.mtl
shines 0 .5 0 >wall.mtl
wall 0 >wall.obj
wait_for_rows 20 "$GREEN"
# the scene itself is away, is missed, and comes back
rm wall.obj
wait_for "wall.obj: no such file"
shines .5 .2 0 | write wall.mtl
wall 0 >wall.obj
wait_for_rows 20 "$ORANGE"
shines 0 .5 0 | write wall.mtl
wait_for_rows 20 "$GREEN"
keys Space Enter
wait_for "NORMAL .*spp"
shines .5 .2 0 | write wall.mtl
wait_for "NORMAL  changed: l loads"
keys l
wait_for "files are loaded only in live mode"
wait_for_rows 20 "$GREEN"
keys Space
wait_for "Unsaved render. Leave it?"
keys y
wait_for_rows 20 "$ORANGE"
keys C-q
expect_end 0

cp /etc/OpenCL/vendors/pocl.icd . 2>/dev/null || exit 0
export OCL_ICD_VENDORS=$PWD
fresh
machine=OpenCL
story -t 1 --backend opencl
