# SPDX-License-Identifier: MIT
# Glass that is wound inwards is told: a cube, also with an opening; not one that
# is wound outwards, a flat one, or a surface alone.
echo 'background 1 1 1' >a.view
printf 'newmtl glass\nKd 0 0 0\nillum 7\nNi 1.5\n' >a.mtl
corners='v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1'
outwards='f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8'
inwards='f 1 2 3 4
f 8 7 6 5
f 5 6 2 1
f 6 7 3 2
f 7 8 4 3
f 8 5 1 4'
try() { # faces, corners
    printf 'mtllib a.mtl\no body\n%s\nusemtl glass\n%s\n' "$2" "$1" >a.obj
    run_untimed -b -w 8 -h 4 -s 1 -c a.view a.obj -o out.png
}
try "$outwards" "$corners"
try "$inwards" "$corners"
# far from the origin, and without a face
try "$inwards" "$(echo "$corners" | sed 's/v \(.\)/v 100\1/')"
try "$(echo "$inwards" | head -n 5)" "$corners"
try "$(echo "$inwards" | head -n 1)" "$corners"
try "$inwards" "$(echo "$corners" | sed 's/.$/0/')"
