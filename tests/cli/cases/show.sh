# SPDX-License-Identifier: MIT
# --show writes properties without a render. A wall faces the camera: its normal
# is blue with half of red and green.
printf 'v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n' >wall.obj
printf 'eye 0 0 5\nat 0 0 0\nres 20 10\n' >wall.view
run_untimed -b --show normals -o normals.png wall.obj
kind normals.png
run_untimed -b --show cost wall.obj
kind wall.png
run_untimed -b --show preview -o preview.png --crop 1,2,3,4 wall.obj
kind preview.png
glim -b --show normals --ansi 2x1 wall.obj 2>err | cat -v
untimed err
glim -b --show faces --ansi 2x1 wall.obj 2>/dev/null | cat -v
glim -b --show uvs --ansi 2x1 wall.obj 2>/dev/null | cat -v
glim -b --show light --ansi 2x1 -s 1 wall.obj 2>/dev/null | wc -l
run --show depth wall.obj
run -b --show samples wall.obj
run -b --show depth -o depth.hdr wall.obj
run -b --show depth --stats - wall.obj
