# SPDX-License-Identifier: MIT
# glim curve: the table, its files, a signal, and every wrong call.
take box
glim -b -w 32 -h 32 -s 512 --seed 9 -o ref.pfm box.obj 2>/dev/null

# Removes the figures of the rows and slopes.
without_times()
{
    awk '/\|/ { rows++; next }
         /^ +[0-9]+ / { print $1, "and", NF - 1; next }
         /^slope/ { sub(/: .*/, ": N"); print; next }
         /^ *\+?-*[0-9 .e-]*$/ { next }
         { print }
         END { if (rows > 0) print rows, "rows of a diagram" }'
}

run curve -s 20 ref.pfm box.obj -o curve.gp --csv curve.csv >text
without_times <text
# its points are those of the table; gnuplot is asked where it is installed
sed -n '/^.curve0/,/^END/p' curve.gp | sed '1d; $d; s/ /,/' >drawn
sed 1d curve.csv | cut -d, -f2,5 >measured
same drawn measured
tail -n 2 curve.gp
if command -v gnuplot >/dev/null; then
    gnuplot curve.gp
    kind curve.png | grep -v 'curve.png: PNG 880x540'
fi
rm -f drawn measured curve.png
cut -d, -f1 curve.csv
# the same render gives the same error
glim -b -w 32 -h 32 -s 8 -o eight.pfm box.obj 2>/dev/null
glim compare eight.pfm ref.pfm | sed -n 's/RMSE *//p' >one
awk '$1 == 8 { print $4 }' text >two
same one two
# one sample: no slope, no diagram
run curve -s 1 ref.pfm box.obj | without_times
run curve -s 1 -o none.gp ref.pfm box.obj | without_times
# the reference's own error, and its seeds
echo '{"mse": 1e-5, "relmse": 2e-5, "first_seed": 9, "seeds": 1}' >ref.json
run curve -s 2 ref.pfm box.obj | without_times | head -2
run curve -s 1 --seed 9 ref.pfm box.obj | grep warning
echo '{"mse": 1, "relmse": 1}' >ref.json
run curve -s 2 ref.pfm box.obj | grep -c 'reference too noisy'
rm ref.json

# a signal ends the measurement; the points before it are reported
interrupt()
{
    for i in $(seq 200); do
        [ "$(wc -l <early)" -lt 6 ] || break
        sleep 0.05
    done
    kill -INT "$(cat pid)"
} 2>/dev/null
: >early
interrupt &
# in the foreground, since programs in the background ignore SIGINT
sh -c 'echo $$ >pid; exec glim "$@"' glim curve -s 1000000000 --csv early.csv \
    ref.pfm box.obj >early 2>&1
echo "exit $?"
wait
rm pid
grep -c '^slope' early
head -2 early.csv | cut -d, -f1

# wrong calls
run curve
run curve ref.pfm
run curve ref.pfm box.obj more.obj
run curve none.pfm box.obj
run curve ref.pfm none.obj
run curve box.obj ref.pfm
run curve -w 20 ref.pfm box.obj
run curve --crop 0,0,3,3 ref.pfm box.obj
run curve -b ref.pfm box.obj
run curve --show depth ref.pfm box.obj
run curve -o curve.pfm ref.pfm box.obj
run curve -o - ref.pfm box.obj
run curve -o curve.png ref.pfm box.obj
run curve --csv - ref.pfm box.obj
run curve -o x.gp --csv x.gp ref.pfm box.obj
run curve --csv ref.pfm ref.pfm box.obj
run curve --csv box.mtl ref.pfm box.obj
run curve --csv none/curve.csv ref.pfm box.obj
run curve --csv '' ref.pfm box.obj
run -b --csv curve.csv box.obj
run curve --device 99 ref.pfm box.obj | head -1 | cut -c 1-20
if [ -e /dev/full ]; then
    glim curve -s 2 ref.pfm box.obj 2>&1 >/dev/full
    echo "exit $?"
fi
ls
