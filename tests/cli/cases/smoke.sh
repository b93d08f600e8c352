# SPDX-License-Identifier: MIT
# Grids: opened themselves, as a medium of a view, and wrong ones.
b="-b -w 8 -h 4 -s 1 -o out.png"
npy '1, 1, 2' '\377\100' >smoke.npy
run_untimed $b smoke.npy
run_untimed $b --up z smoke.npy
printf 'v -1 0 -1\nv 1 0 -1\nv 0 0 1\nf 3 2 1\n' >scene.obj
echo 'medium smoke.npy scatter 2 2 2 box -1 0 -1 1 1 1' >scene.view
run_untimed $b scene.obj
kind out.png
echo 'medium smoke.npy grid density scatter 2 2 2' >scene.view
run $b scene.obj
echo 'medium none.vdb scatter 2 2 2' >scene.view
run $b scene.obj
echo 'medium smoke.npy box 1 0 0 0 1 1' >scene.view
run $b scene.obj
npy '1, 2' '\377\100' >flat.npy
run $b flat.npy
npy '1, 1, 3' '\377\100' >short.npy
run $b short.npy
printf ' BDV\000\000\000\000' >short.vdb
run $b short.vdb
printf 'NanoVDB0\000\000\000\000' >smoke.nvdb
run $b smoke.nvdb
npy '1, 1, 2' '\000\000' >empty.npy
run_untimed $b empty.npy
