# SPDX-License-Identifier: MIT
# The smallest pictures work, the largest is refused with what it would need.
take box
for size in 1x1 1x37 37x1 3000x1; do
    run_untimed -b -w ${size%x*} -h ${size#*x} -s 2 -o $size.png box.obj
    kind $size.png
done
run -b -w 65536 -h 65536 -s 1 -o big.png box.obj |
    sed 's/found [0-9.]* GiB/found N GiB/'
[ ! -e big.png ] || echo "big.png is there"
