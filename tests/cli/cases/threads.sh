# SPDX-License-Identifier: MIT
# The bytes do not depend on the number of threads; they depend on the seed.
take box
b="-b -w 40 -h 30 -s 11 --seed 3"
for threads in 1 2 5 64; do
    glim $b -t $threads -o $threads.pfm box.obj 2>/dev/null
done
same 1.pfm 2.pfm
same 1.pfm 5.pfm
same 1.pfm 64.pfm
glim $b -o default.pfm box.obj 2>/dev/null
same 1.pfm default.pfm
glim $b --seed 4294967295 -o seed.pfm box.obj 2>/dev/null
same 1.pfm seed.pfm
