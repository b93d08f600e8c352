# SPDX-License-Identifier: MIT
# Killed at any time, the old picture or the new one is there, complete.
take box
b="-b -w 200 -h 150 -s 1 -t 1"
glim $b --seed 1 -o old.pfm box.obj 2>/dev/null
glim $b --seed 2 -o new.pfm box.obj 2>/dev/null
for i in 01 02 03 04 05 06 07 08 09 10 12 14; do
    cp old.pfm out.pfm
    timeout -s KILL 0.$i glim $b --seed 2 -o out.pfm box.obj 2>/dev/null
    cmp -s out.pfm old.pfm || cmp -s out.pfm new.pfm || echo "torn at 0.$i s"
done 2>/dev/null
echo done
