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
# Media of coefficients and cosines at their limits, in a body around the eye and
# as fog that ends nowhere: no sample is lost, and paths end.
printf 'mtllib body.mtl\nusemtl m\n' >body.obj
printf 'v %s\n' '-1 -1 -1' '1 -1 -1' '-1 1 -1' '1 1 -1' '-1 -1 1' '1 -1 1' \
    '-1 1 1' '1 1 1' >>body.obj
printf 'f %s\n' '1 3 4 2' '5 6 8 7' '1 2 6 5' '3 7 8 4' '1 5 7 3' '2 4 8 6' \
    >>body.obj
render() # WHAT
{
    glim -b -w 6 -h 4 -s 2 -t 1 -o body.pfm body.obj >body.out 2>&1 &&
        ! grep -q warning body.out || { echo "$1:" && cat body.out; }
}
for sigma in 0 1e-30 1 1e30; do
    for g in -1 0 1; do
        printf 'newmtl m\nillum 7\nNi 1\nTf_scatter %s 0 1\nTf_absorb %s %s 0\n' \
            $sigma 0 $sigma >body.mtl
        printf 'Tf_anisotropy %s\n' $g >>body.mtl
        printf 'eye 0 0 .5\nat 0 0 0\nbackground 1 1 1\n%s\n' \
            'light point .5 .5 0' >body.view
        render "body of $sigma, $g"
        printf 'newmtl m\nKd .5\n' >body.mtl
        for falloff in 0 1e-30 1e-3 1e30; do
            printf 'eye 0 0 3\nat 0 0 0\nbackground 1 1 1\n%s\n' \
                'light point .5 1.5 0' >body.view
            printf 'fog scatter %s 0 1 absorb 0 %s 0 anisotropy %s %s %s\n' \
                $sigma $sigma $g 'height 0 falloff' $falloff >>body.view
            render "fog of $sigma, $g, $falloff"
        done
    done
done
# A falloff below all floats is no fog above its height, not an even one.
printf 'newmtl m\nKd 0\nKe 1\n' >body.mtl
printf 'eye 0 0 3\nat 0 0 0\nmax_bounces 0\n' >body.view
render "no fog" && cp body.pfm clear.pfm
echo 'fog absorb 1 1 1 height -9 falloff 1e-50' >>body.view
render "fog without a height"
same body.pfm clear.pfm
