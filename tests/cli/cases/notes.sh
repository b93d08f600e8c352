# SPDX-License-Identifier: MIT
# Notes about a scene are printed, and the picture is made.
take plain box
b="-b -w 8 -h 4 -s 1 -o out.png"
run_untimed $b plain.obj
echo 'background 0 0 0' >plain.view
run_untimed $b plain.obj
printf 'v 0 0 0\n' >points.obj
run_untimed $b points.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\nf 1 2 0\n' >index.obj
run_untimed $b index.obj
printf 'mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >nomtl.obj
run_untimed $b nomtl.obj
printf 'eye 0.3 0.3 2\nat 0.3 0.3 0\nup 0 0 3\n' >plain.view
run_untimed $b plain.obj
kind out.png
