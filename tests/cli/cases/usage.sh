# SPDX-License-Identifier: MIT
# Errors on the command line cause one line that names them, and status 2.
take box
run
run -b
run -h
run -h box.obj
run -w abc box.obj
run -b -t 0 box.obj
run -b -s -1 box.obj
run -b -d 1000 box.obj
run -b --seed 4294967296 box.obj
run -b --crop 1,2,3 box.obj
run -b --up x box.obj
run -b --color red box.obj
run -b -o out.jpg box.obj
run -b --nonsense box.obj
run -b -z box.obj
run -b --backend gpu box.obj
run -b --backend cpu --device 1 box.obj
run -b --backend=cpu --kernels . box.obj
run -b --device '' box.obj
run --list-devices=1
run -b box.obj other.obj
run -b -f
run -b -o - --stats - box.obj
run -o out.png box.obj
run -b --watch box.obj
run box.obj
ls
