# SPDX-License-Identifier: MIT
# Scenes that cannot be read: one line with the place, status 1.
b="-b -w 8 -h 4 -s 1 -o out.png"
run $b missing.obj
mkdir folder.obj
run $b folder.obj
: >empty.obj
run $b empty.obj
head -c 3000 "$(command -v glim)" >binary.obj
run $b binary.obj
printf 'v 0 0 0\nv 1 x 0\n' >number.obj
run $b number.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >fine.obj
run $b -c missing.view fine.obj
ls
