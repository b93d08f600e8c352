# SPDX-License-Identifier: MIT
# Radiance cells change pictures, but not with threads, instructions, the
# backend, crops, halts, shares or ranks.
cat >room.mtl <<EOF
newmtl wall
Kd .8 .7 .6
newmtl lamp
Kd .5 .5 .5
Ke 9 9 9
EOF
cat >room.obj <<EOF
mtllib room.mtl
usemtl wall
v -1 -1 -1
v -1 -1 1
v 1 -1 1
v 1 -1 -1
v -1 1 -1
v -1 1 1
v 1 1 1
v 1 1 -1
f 1 2 3 4
f 5 8 7 6
f 1 5 6 2
f 4 3 7 8
f 1 4 8 5
f 2 6 7 3
v .2 -1 -1
v .2 .5 -1
v .2 .5 1
v .2 -1 1
f -4 -3 -2 -1
usemtl lamp
v .4 .9 -.3
v .8 .9 -.3
v .8 .9 .3
v .4 .9 .3
f -4 -3 -2 -1
EOF
printf 'eye -.8 .3 .9\nat 0 -.4 -1\nfovy 60\nbackground 0 0 0\n' >room.view
b="-b -w 64 -h 48 -s 60"
glim $b -t 1 -o whole.pfm room.obj 2>/dev/null
glim $b --gi exact -o exact.pfm room.obj 2>/dev/null
same exact.pfm whole.pfm
glim $b -t 3 --isa plain -o other.pfm room.obj 2>/dev/null
same other.pfm whole.pfm
glim $b --backend opencl -o device.pfm room.obj 2>/dev/null
same device.pfm whole.pfm

glim $b --crop 9,5,20,30 -o part.pfm room.obj 2>/dev/null
floats whole.pfm 64 48 | awk '
    { x = (NR - 1) % 64; y = 47 - int((NR - 1) / 64) }
    x >= 9 && x < 29 && y >= 5 && y < 35' >expected
floats part.pfm 20 30 >found
same expected found

for spp in 31 33; do
    glim $b -s $spp --film a.film -o other.pfm room.obj 2>/dev/null
    glim $b --resume a.film -o other.pfm room.obj 2>/dev/null
    same other.pfm whole.pfm
done
glim $b --gi exact --resume a.film -o other.pfm room.obj 2>&1 | grep -o 'a.film: .*'
for i in 1 2 3; do
    glim $b --share $i/3 --film $i.film -o other.pfm room.obj 2>/dev/null
done
glim merge -o other.pfm 3.film 1.film 2.film 2>/dev/null
same other.pfm whole.pfm

mpi=$root/${BUILD:-build/release}/mpi/glim
if command -v mpirun >/dev/null && [ -x "$mpi" ]; then
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout -k 5 60 \
        mpirun --oversubscribe -n 3 "$mpi" $b -o other.pfm room.obj 2>/dev/null
    cmp other.pfm whole.pfm
fi
