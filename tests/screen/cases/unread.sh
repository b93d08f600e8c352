# SPDX-License-Identifier: MIT
# An OBJ file that cannot be read, or not all of it, says why: at the start, on
# the screen, and when it is loaded again, where the scene of before stays.
flat_scene
printf 'v 0 0 9\nv 1 0 x\nv 0 1 9\nf 1 2 3\n' >broken.obj
start broken.obj
wait_for "^glim: broken.obj:2: found 'x' after v, expected a number"
expect_end 1
fresh
printf 'mtllib gone.mtl\n' | cat - flat.obj >some.obj
cp flat.view some.view
size=100x21
start some.obj
wait_for "LIVE  some.obj:1: found no file 'gone.mtl' for mtllib"
keys C-q
expect_end 0
fresh
printf 'f 1 2 7\n' | cat flat.obj - >some.obj
start some.obj
wait_for "LIVE  some.obj:5: found vertex 7 in a face, expected 1 to 3"
cp broken.obj some.obj
keys l
wait_for "some.obj:2: found 'x' after v, expected a number"
wait_for_rows 20 '48;2;188;124;0'
keys C-q
expect_end 0
