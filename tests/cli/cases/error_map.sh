# SPDX-License-Identifier: MIT
# --error-map writes the error of each pixel. A lamp that fills the picture has
# none: black.
take box
printf 'newmtl lamp\nKe 1 1 1\n' >lamp.mtl
printf 'mtllib lamp.mtl\nusemtl lamp\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\n' \
    >lamp.obj
printf 'f 1 2 3 4\n' >>lamp.obj
printf 'eye 0 0 5\nat 0 0 0\nres 20 10\n' >lamp.view
run_untimed -b -s 2 -o lamp.png --error-map lamp.pfm lamp.obj
kind lamp.pfm
tail -c 2400 lamp.pfm | tr -d '\000' | wc -c
run_untimed -b -w 20 -h 10 -s 2 -o box.png --error-map map.png box.obj
kind map.png
run_untimed -b -w 20 -h 10 -s 2 -o box.png --error-map map.hdr box.obj
kind map.hdr
run_untimed -b -w 20 -h 10 -s 2 --ansi 8x4 -o box.ans --error-map text.png \
    box.obj
kind text.png
# The root mean square of the map is the error of the picture, but for means at
# the sides of the picture. Both are relative to the exposed white.
for exposure in -5 0 5; do
    glim -b -w 40 -h 30 -s 16 --exposure $exposure --error-map map.pfm \
        --stats run.json -o box.png box.obj 2>/dev/null
    error=$(sed -n 's/.*"error": \(.*\),/\1/p' run.json)
    floats map.pfm 40 30 | awk -v error="$error" '{ squares += $1 * $1 }
        END { map = sqrt(squares / NR)
            if (map < 1.1 * error && error < 1.1 * map) print "the same error"
            else print "found " map " and " error }'
    echo "$error" >>errors
done
awk '$1 > 1.3 * last { more++ } { last = $1 } END { print more, "rise" }' errors
b="-b -w 8 -h 4 -s 1000000000"
run --error-map map.png box.obj
run $b --error-map map.jpg box.obj
run $b --error-map - box.obj
run $b --error-map none/map.png box.obj
run $b --error-map box.mtl box.obj
ln -s box.mtl link.png
run $b --error-map link.png box.obj
run $b -o out.png --error-map ./out.png box.obj
run $b --stats map.png --error-map map.png box.obj
run -b -s 1 --error-map map.png box.obj
run -b --show depth --error-map map.png box.obj
run $b --denoise=map.png --error-map map.png box.obj
rm box.png
run_untimed -b -w 8 -h 4 -s 2 --error-map box.png box.obj
