# SPDX-License-Identifier: MIT
# -e, --time and -s: the first that holds ends the render, and the closing line
# and the statistics say which.
take box
b="-b -w 40 -h 30 -o out.png"
# Runs glim and prints the limit of the closing line.
limit()
{
    run $b "$@" box.obj | sed 's/40x30, .*/40x30 .../'
}
limit -s 4
limit -e 20%
limit -e .2
limit --time 0.3
limit --time .02m
limit -s 4 -e 0.0001% --time 1h
limit -s 1000000000 -e 20% --time 1h
limit -s 1000000000 -e 1e-9% --time .3s
echo 'samples are a limit only if they are given:'
glim $b -e 10% --stats run.json box.obj 2>/dev/null
grep -E '"(spp|stopped|stopped_by|resolved)":' run.json |
    sed 's/"spp": 16,/sixteen/; s/"spp": [0-9]*/"spp": N/'
# the upper end of the error is at most the limit
awk -F '[:,]' '/"error/ { e[$1] = $2 }
    END {
        low = e["  \"error_low\""]; high = e["  \"error_high\""]
        error = e["  \"error\""]
        if (low < error && error < high && high <= .1 && low > .02)
            print "the error is plausible"
        else
            print "found " low " " error " " high
    }' run.json
echo 'the same limit gives the same picture with any number of threads:'
glim $b -t 1 -e 10% -o one.png box.obj 2>/dev/null
glim $b -t 3 -e 10% -o three.png box.obj 2>/dev/null
same one.png three.png
LC_ALL=C tr '\0' '=' <one.png | LC_ALL=C grep -a -o -e 'glim:stopped_by=error' \
    -e 'glim:error_high=0.0' -e 'glim:resolved=[a-z]*'
echo 'no light: the error is 0, which counts from 16 samples on'
cp box.obj dark.obj
printf 'background 0 0 0\n' >dark.view
printf 'newmtl %s\nKd 1 1 1\n' white red green lamp >dark.mtl
sed 's/box.mtl/dark.mtl/' box.obj >dark.obj
run $b -e 1% dark.obj | sed 's/, [0-9.]* s, /, T s, /'
echo 'one pixel:'
run_untimed $b --crop 3,3,1,1 --time .1 box.obj | sed 's/[0-9]* spp/N spp/'
echo 'errors:'
for e in 0 0% -1% nan inf 1 5 101% 1%% '' x 1e-400 '1 %' %; do
    run -b -e "$e" box.obj
done
for time in 0 0s -1 nan inf 1e99 1d 1m30s '' x 1.5.5 '1 s' s; do
    run -b --time "$time" box.obj
done
rm out.png
run $b --time 1e-9 box.obj
[ -e out.png ] || echo "no file"
