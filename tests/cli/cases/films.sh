# SPDX-License-Identifier: MIT
# A render that stops, moves and is cut in pieces has the bytes of one that does
# not.
take box
b="-b -w 48 -h 36 -s 40"
glim $b --seed 5 -o whole.png box.obj 2>/dev/null

# stopped at any number of samples, on other threads and instructions
for spp in 1 3 16 17 39 40; do
    glim $b --seed 5 -s $spp -t 1 --film a.film -o a.png box.obj 2>/dev/null
    glim $b --seed 5 -t 2 --isa plain --resume a.film --film b.film -o b.png \
        box.obj 2>/dev/null
    same b.png whole.png
    glim develop b.film -o b.png 2>/dev/null
    same b.png whole.png
done
# a film that has the samples already
run_untimed $b --seed 5 --resume b.film -o b.png box.obj
same b.png whole.png

# the scene in another folder, under another name, with comments
mkdir other
(echo "# moved"; cat box.obj) >other/box.obj
cp box.mtl box.view other
glim $b --seed 5 -s 7 --film a.film -o a.png box.obj 2>/dev/null
glim $b --seed 5 --resume a.film -o b.png other/box.obj 2>/dev/null
same b.png whole.png

# shares, in any order
for i in 1 2 3 4 5; do
    glim $b --seed 5 --share $i/5 --film $i.film -o x.png box.obj 2>/dev/null
done
run_untimed merge -o m.png 4.film 1.film 5.film 2.film 3.film
same m.png whole.png
run_untimed merge -o half.film 4.film 1.film
run_untimed merge -o m.png 3.film half.film 5.film 2.film
same m.png whole.png
run info half.film | grep -E 'samples|total|seed|picture|exit'

# adaptive, and with features for the filter
glim $b --adaptive --denoise -o whole.png box.obj 2>/dev/null
for spp in 9 16 23; do
    glim $b -s $spp --adaptive --denoise --film a.film -o a.png box.obj \
        2>/dev/null
    glim $b --adaptive --denoise --resume a.film --film b.film -o b.png \
        box.obj 2>/dev/null
    same b.png whole.png
done
glim develop --denoise b.film -o m.png 2>/dev/null
run_untimed develop --denoise=n.png b.film -o b.png
same n.png m.png
run merge --denoise b.film -o n.film

# what films say of themselves: the error of the render, whether they can be
# filtered, and the limit that they have reached
render=$(glim $b --exposure 3 --film a.film -o a.png box.obj 2>&1 |
    sed 's/.*error //')
merge=$(glim merge -o m.png a.film 2>&1 | sed 's/.*error //')
info=$(glim info a.film | sed -n 's/^  error *//p')
case $render in
*%*to*%*) ;;
*) echo "found $render" ;;
esac
[ "$render" = "$merge" ] && [ "$render" = "$info" ] && echo "one error"
same a.png m.png
glim info a.film b.film | grep denoising
if [ -e /dev/full ]; then
    glim info a.film 2>&1 >/dev/full
    echo "exit $?"
fi
glim merge -o half.png half.film 2>/dev/null
for picture in n b half; do
    head -c 900 $picture.png | LC_ALL=C tr '\0' '=' | LC_ALL=C grep -a -o \
        -e 'glim:denoised=true' -e 'glim:stopped_by=samples'
    echo "of $picture"
done

# the limit of the error ends a resumed render where it ends the other one
e="-b -w 48 -h 36 -e 20%"
glim $e -o whole.png box.obj 2>/dev/null
glim $e -s 19 --film a.film -o a.png box.obj 2>/dev/null
glim $e --resume a.film -o b.png box.obj 2>/dev/null
same b.png whole.png

# exposure and tone of the picture
glim develop --exposure 1 --tone aces b.film -o a.png 2>/dev/null
glim develop b.film -o b.png 2>/dev/null
same a.png b.png
