# SPDX-License-Identifier: MIT
# Values of the view as options: what they refuse, and the same pictures as with
# the same values in a view file.
take box
b="-b -w 24 -h 16 -s 2"
for eye in '' 1 1,2 1,2,3,4 1,2,x 1e31,0,0 nan,0,0 '1 2 3' 1,2,3,; do
    run $b --eye "$eye" box.obj
done
run $b --at
run $b --up 0,0,0 box.obj
for fov in 0 180 40x; do
    run $b --fov $fov box.obj
done
run $b --sky-strength -1 box.obj
run $b --sky-rotation 2e6 box.obj
run $b --exposure 101 box.obj
run $b --tone filmic box.obj
run $b --sky '' box.obj
run $b --sky 'none ' box.obj
run $b --sky none.hdr box.obj
run $b --sky 1,2,3 --sun 0,45 box.obj
run $b --eye 1,2,3 --at 1,2,3 box.obj
: >empty.view
run $b --eye 1,2,3 -c empty.view box.obj
run $b --camera '' box.obj
run $b --camera 4 box.obj
run $b --camera Front box.obj
run compare --eye 1,2,3 a.pfm b.pfm
run merge --eye 1,2,3 -o a.png a.film

# every option, and its key
printf 'P6 2 1 255\n\377\200\100\100\200\377' >sky.ppm
printf 'view 3 eye 1 3 4 at 0 1 0 fovy 50\n' >>box.view
run $b --camera 4 box.obj
cp box.view file.view
printf 'eye 1 2 5\nat 0 0.5 0\nup 0.1 1 0\nfovy 33\nexposure 0.5\ntone aces\n' \
    >>file.view
printf 'sky sky.ppm\nsky_strength 2\nsky_rotation 30\n' >>file.view
glim $b -o file.png -c file.view box.obj 2>/dev/null
glim $b -o options.png --eye 1,2,5 --at 0,.5,0 --up .1,1,0 --fov 33 \
    --exposure .5 --tone aces --sky sky.ppm --sky-strength 2 --sky-rotation 30 \
    box.obj 2>/dev/null
same file.png options.png
# the same on the way of --stats, which libglim does not take
glim $b -o stats.png --stats s.json --eye 1,2,5 --at 0,.5,0 --up .1,1,0 \
    --fov 33 --exposure .5 --tone aces --sky sky.ppm --sky-strength 2 \
    --sky-rotation 30 box.obj 2>/dev/null
same file.png stats.png

# a numbered view, and a value over it
printf 'eye 1 3 4\nat 0 1 0\nfovy 20\n' | cat box.view - >file.view
glim $b -o file.png -c file.view box.obj 2>/dev/null
glim $b -o options.png --camera 3 --fov 20 box.obj 2>/dev/null
same file.png options.png

# a colour goes over an image and a sun of the file, an image over its sun; of
# two options the last one counts
grep -v -e '^background' -e '^sky' -e '^sun' box.view >plain.view
printf 'background 1 0.21586050011389923 0\n' | cat plain.view - >file.view
glim $b -o file.pfm -c file.view box.obj 2>/dev/null
printf 'sun 20 30\nsky sky.ppm\n' | cat plain.view - >box.view
glim $b -o options.pfm --sky sky.ppm --sky '#ff8000' box.obj 2>/dev/null
same file.pfm options.pfm
printf 'sky sky.ppm\n' | cat plain.view - >file.view
glim $b -o file.pfm -c file.view box.obj 2>/dev/null
glim $b -o options.pfm --sky sky.ppm box.obj 2>/dev/null
same file.pfm options.pfm
