# SPDX-License-Identifier: MIT
# --denoise writes a filtered picture instead of the raw one, or beside it; it
# has less noise, and the same bytes with any number of threads.
take box
b="-b -w 40 -h 30 -s 8 --seed 3"
echo 'background 1 1 1' >box.view
run_untimed $b -t 1 -o raw.pfm box.obj
run_untimed $b -t 1 --denoise --stats run.json -o a.pfm box.obj
grep denoised run.json
run_untimed $b -t 3 --denoise=b.pfm --stats run.json -o beside.pfm box.obj
grep denoised run.json
run_untimed $b -t 2 --isa plain --denoise -o c.pfm box.obj
same a.pfm b.pfm
same a.pfm c.pfm
same a.pfm raw.pfm
same raw.pfm beside.pfm
run_untimed $b --denoise -o a.png box.obj
head -c 900 a.png | LC_ALL=C tr '\0' '=' |
    LC_ALL=C grep -a -o 'glim:denoised=true'
for stats in '' '--stats run.json'; do
    run_untimed $b $stats --denoise=b.png -o raw.png box.obj
    head -c 900 raw.png | LC_ALL=C grep -a -c denoised
    head -c 900 b.png | LC_ALL=C grep -a -c denoised
done
run_untimed $b --denoise --ansi 10x2 --color mono --glyph ascii box.obj
# relMSE against a converged picture falls
run_untimed $b -s 4000 -o true.pfm box.obj >/dev/null
for f in raw a; do
    glim compare $f.pfm true.pfm | awk '/^relMSE/ { print $2 }'
done | awk '{ e[NR] = $1 } END { print e[2] < e[1] / 2 ? "less noise" : e[1] " " e[2] }'
echo 'one sample, and mistakes:'
run_untimed -b -w 4 -h 3 -s 1 --denoise --stats run.json -o a.pfm box.obj
grep denoised run.json
run --denoise box.obj
run -b --denoise --show normals box.obj
run -b --denoise= box.obj
run -b --denoise=a.jpg box.obj
run -b --denoise=- box.obj
run -b --denoise=./a.png -o a.png box.obj
run -b --denoise=a.png --stats a.png box.obj
run -b --denoise=no/a.png box.obj
ls
