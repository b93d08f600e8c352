# SPDX-License-Identifier: MIT
# The smallest pictures work; the largest is refused with the memory it needs.
take box
for size in 1x1 1x37 37x1 3000x1; do
    run_untimed -b -w ${size%x*} -h ${size#*x} -s 2 -o $size.png box.obj
    kind $size.png
done
run -b -w 65536 -h 65536 -s 1 -o big.png box.obj |
    sed 's/found [0-9.]* GiB .*/found N GiB/'
[ ! -e big.png ] || echo "big.png is there"
# the message names the limit
limit_memory 3000000 || exit 0
glim -b -w 5900 -h 5900 -s 1 -o big.png box.obj 2>&1 |
    grep -v 'needs 3.4 GiB of memory, found 2.9 GiB under ulimit -v$'
glim -b -w 5430 -h 5430 -s 1 -o big.png box.obj 2>&1 |
    grep -v 'needs 2.9 GiB of memory, more than is left of the 2.9 GiB under ulimit -v$'
exit 0
