# SPDX-License-Identifier: MIT
# Turntables and flights: names, what they refuse, and each frame the same as a
# picture of its own.
take box
b="-b -w 24 -h 16 -s 2"
for n in 0 x 1000001; do
    run $b --turntable $n box.obj
done
run $b --fly 1 box.obj
for frames in 1 1: :2 3:2 1:2:3 0:1000000; do
    run $b --turntable 4 --frames $frames box.obj
done
run $b --frames 0:3 box.obj
run $b --turntable 4 --frames 2:4 box.obj
run $b --turntable 4 --fly 4 box.obj
run $b --turntable 4 -o - box.obj
run $b --turntable 4 --film a.film box.obj
run --turntable 4 box.obj
run $b --fly 4 box.obj
run_untimed $b --turntable 2 -o none/out.png box.obj
ls

# quarters of a turn: the eye is 4 units from the axis through 0 1 0
run_untimed $b --turntable 4 -o t.pfm box.obj
for eye in 0:0,1,4 1:4,1,0 2:0,1,-4 3:-4,1,0; do
    glim $b -o one.pfm --eye ${eye#*:} --at 0,1,0 box.obj 2>/dev/null
    same t-000${eye%%:*}.pfm one.pfm
done
# a part of them, under another name, replaces old files
echo old >part02.pfm
run_untimed $b --turntable 4 --frames 1:2 -o part%02d.pfm box.obj
same t-0001.pfm part01.pfm
same t-0002.pfm part02.pfm
# one eighth is 45 degrees
glim $b --turntable 8 --frames 1:1 -o e.pfm box.obj 2>/dev/null
glim $b -o one.pfm --eye 2.8284271247461903,1,2.8284271247461903 --at 0,1,0 \
    box.obj 2>/dev/null
same e-0001.pfm one.pfm

# a flight through three views, of which every second frame is one
cat >>box.view <<'V'
view 2 eye 0 1 4 at 0 1 0
view 5 eye 3 2 3 at 0 1 0 fovy 60
view 9 eye 4 1 -1 at 0 0.5 0 fovy 30
V
run_untimed $b --fly 5 -o f.pfm box.obj
for frame in 0:2 2:5 4:9; do
    glim $b -o one.pfm --camera ${frame#*:} box.obj 2>/dev/null
    same f-000${frame%%:*}.pfm one.pfm
done

# files beside the picture, properties, text, and no name
glim $b --turntable 2 -o a.png --denoise=d.png --error-map e.png \
    --stats s.json box.obj 2>/dev/null
ls a-* d-* e-00* s-*
run_untimed $b --turntable 2 --show normals box.obj
glim -b -w 24 -h 16 -s 1 --turntable 2 --ansi 4x1 --color mono --glyph ascii \
    box.obj 2>/dev/null | wc -l
