# SPDX-License-Identifier: MIT
# Files of other programs: their files are found, and unsupported statements are
# reported once.
b="-b -w 8 -h 4 -s 1 -o out.png"
face='v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n'
# names from a system that ignores letter case
mkdir -p Maps
printf "newmtl a\nmap_Ke maps\\\\WALL.png\n" >walls.mtl
printf "mtllib WALLS.MTL\nusemtl a\n$face" >walls.obj
run_untimed -b -w 8 -h 4 -s 1 -o Maps/Wall.PNG walls.obj
run_untimed $b walls.obj
# a missing texture, with the line that names it
printf 'newmtl a\nKd 1 1 1\nmap_Kd none\\wood.jpg\n' >wood.mtl
printf "mtllib wood.mtl\nusemtl a\n$face" >wood.obj
run_untimed $b wood.obj
# vertex colours, weights
printf 'v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 0 0 0 1\nf 1 2 3\n' >colors.obj
run_untimed $b colors.obj
printf 'v -1 -1 0 1\nv 1 -1 0 1\nv 1 1 0 1\nf 1 2 3\n' >weights.obj
run_untimed $b weights.obj
# free-form surfaces
printf "${face}cstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 3\nend\n" >forms.obj
run_untimed $b forms.obj
# invisible materials
printf 'newmtl a\nKd 1 1 1\nTr 1\n' >unseen.mtl
printf "mtllib unseen.mtl\nusemtl a\n$face" >unseen.obj
run_untimed $b unseen.obj
# an invisible lamp gives no light
printf 'newmtl a\nKe 9 9 9\nd 0\nnewmtl b\nKd .5 .5 .5\n' >lamp.mtl
{
    printf "mtllib lamp.mtl\nusemtl a\n$face"
    printf 'v -9 -9 -5\nv 9 -9 -5\nv 0 9 -5\nusemtl b\nf 4 5 6\n'
} >lamp.obj
run_untimed -b -w 8 -h 4 -s 1 -o lamp.pfm lamp.obj
floats lamp.pfm 8 4 | awk '{ n += $1 > 0 } END { print (n > 0 ? "lit" : "black") }'
# text in UTF-16, which Windows programs write
{
    printf '\377\376'
    sed 's/./&\x00/g' wood.mtl | tr -d '\n'
} >wide.mtl
printf "mtllib wide.mtl\nusemtl a\n$face" >wide.obj
run_untimed $b wide.obj
cp wide.mtl wide.obj
run_untimed $b wide.obj
# options of other programs, quotes
printf 'newmtl a\nmap_Ke -colorspace sRGB "maps\\WALL.png"\n' >quotes.mtl
printf "mtllib \"quotes.mtl\"\nusemtl a\n$face" >quotes.obj
run_untimed $b quotes.obj
