# SPDX-License-Identifier: MIT
# An edge of 5e38 beside one of 1: the face had no finite normal, and a ray that
# left it never ended.
printf 'v %s\n' '-5e38 0 0' '0 0 0' '0 0 1' '0 1 0' >needle.obj
printf 'f 1 2 3\nf 1 4 3\n' >>needle.obj
printf 'v %s\n' '0 0 0' '0 0 1' '0 .79 1' '0 1 0' '-1e38 0 0' '0 0 -1e38' \
    >corners.obj
printf 'f 5 1 2\nf 1 4 3 6\n' >>corners.obj
for name in needle corners; do
    for isa in plain avx2 avx512; do
        glim -b -w 8 -h 8 -s 1 --isa $isa -o $name.$isa.pfm $name.obj \
            >$isa.out 2>&1 || grep -q "one of this processor's" $isa.out ||
            echo "$name $isa: $?"
    done
    run_untimed -b -w 8 -h 8 -s 1 -t 1 -o $name.png $name.obj |
        grep -v "crosses itself" # what a polygon is cut into is not meant here
done
# Light that does not fit the sums is cut, with a message from each program.
printf 'v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n' >bright.obj
printf 'eye 0 0 5\nat 0 0 0\nbackground 2e18 2e18 2e18\n' >bright.view
b="-w 8 -h 8"
run_untimed -b $b -s 4 -o fits.pfm bright.obj
run_untimed -b $b -s 10 --film bright.film -o cut.png bright.obj
glim info bright.film | grep fault
run_untimed develop -o cut.png bright.film
glim reference $b -s 80 ref.pfm bright.obj 2>&1 | grep warning
glim curve -s 8 ref.pfm bright.obj 2>&1 >/dev/null | grep warning
