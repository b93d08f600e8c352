# SPDX-License-Identifier: MIT
# --stats writes one JSON object; counts follow from the size, times are
# ordered.
take box
glim -b -w 20 -h 10 -s 3 -t 2 --seed 7 -o out.png --stats run.json box.obj \
    2>/dev/null
sed -n 's/^  \("[a-z_]*"\).*/\1/p' run.json | tr '\n' ' '
echo
grep -E '"(width|height|spp|threads|samples|seed|triangles|instances|non_finite)":' run.json
grep -E '"(backend|scene|stopped|stopped_by|resolved)":' run.json
awk -F '[:,]' '/(load|build|picture|render|total|span)_s"/ { t[$1] = $2 + 0; if ($2 !~ /^ [0-9]+\.[0-9]+$/) bad = 1 }
    /"rays"/ { rays = $2 }
    END {
        sum = t["  \"load_s\""] + t["  \"build_s\""] + t["  \"render_s\""]
        print (!bad && sum <= t["  \"total_s\""] &&
            t["  \"first_picture_s\""] <= t["  \"total_s\""] &&
            rays >= 600) ? "times and rays are plausible" : "implausible"
    }' run.json
grep -E '"(percent|left_s)"' run.json
# rates and the speeds of all spans follow from samples and times; each of the
# two threads has a load
awk -F '[][,:]' '{ value[$1] = $2 + 0 }
    /"speeds"/ { for (i = 3; i < NF; i++) speed[n++] = $i }
    /"load"/ { loads = NF - 4; for (i = 3; i < NF - 1; i++) bad += $i < 0 || $i > 1 }
    END {
        render = value["  \"render_s\""]
        time = render + value["  \"build_s\""]
        span = value["  \"span_s\""]
        for (i = 0; i < n; i++) {
            left = time - i * span
            sum += speed[i] * (left < span ? left : span)
        }
        rate = value["  \"samples_per_s\""] * render
        rays = value["  \"rays_per_s\""] * render / value["  \"rays\""]
        if (sum > 594 && sum < 606 && rate > 594 && rate < 606 &&
            rays > .99 && rays < 1.01 && loads == 2 && !bad)
            print "rates and speeds agree"
        else
            print "they do not: " sum " " rate " " rays
    }' run.json
glim -b -w 4 -h 4 -s 1 -o out.png --stats - box.obj 2>/dev/null | head -n 1
echo 'crop and odd names:'
cp box.obj 'a"b\c.obj'
glim -b -w 9 -h 9 --crop 1,1,3,2 -s 1 -o out.png --stats run.json 'a"b\c.obj' \
    2>/dev/null
grep -E '"(width|height|samples|scene|error|error_low|error_high|resolved)":' \
    run.json
echo 'what is dropped and what nobody uses:'
{
    cat box.obj
    printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf -3 -2 -1\n'
} > thin.obj
chmod u+w box.mtl
printf 'newmtl nobody\nmap_Kd no-such-file.png\n' >> box.mtl
glim -b -w 2 -h 2 -s 1 -o out.png --stats run.json thin.obj 2>&1 |
    grep warning
grep -E '"(triangles|instances|dropped_triangles|materials|unused_materials)"' run.json
