# SPDX-License-Identifier: MIT
# glim reference: the mean of several seeds, its error, a signal, wrong calls.
take box

# Removes the figures that differ between runs.
untimed()
{
    sed 's/relMSE.*), [0-9.]* s$/relMSE N, T s/'
}

run reference -w 24 -h 24 -s 64 --seeds 4 ref.pfm box.obj | untimed
kind ref.pfm
sed 's/\("\(seconds\|mean\|.*mse.*\)": \)[0-9.e-]*/\1N/
    s/\["[^"]*glim"/["glim"/; s/glim [0-9.]*/glim V/' ref.json
# the mean of its seeds, which glim renders alone as well
for seed in 1000000 1000001 1000002 1000003; do
    glim -b -w 24 -h 24 -s 16 --seed $seed -o $seed.pfm box.obj 2>/dev/null
    floats $seed.pfm 24 24 >$seed.txt
done
floats ref.pfm 24 24 >ref.txt
paste 1000000.txt 1000001.txt 1000002.txt 1000003.txt ref.txt |
    awk '{ for (i = 1; i <= 3; i++) {
               d = ($i + $(i + 3) + $(i + 6) + $(i + 9)) / 4 - $(i + 12)
               if (d * d > 1e-10) bad++ } }
         END { print NR, "pixels,", bad + 0, "differ from the mean" }'
# curve and compare know its error and its seeds
run curve -s 1 --seed 1000003 ref.pfm box.obj | grep -c 'one of the seeds'
run curve -s 1 --seed 1000004 ref.pfm box.obj | grep -c 'one of the seeds'
glim compare 1000000.pfm ref.pfm | grep -c "without the reference's own"
# an uneven number of samples is rounded up; seeds from --seed on
run reference -w 8 -h 8 -s 5 --seeds 4 --seed 0 five.pfm box.obj | untimed
grep -c '"first_seed": 0,' five.json
run reference -w 1 -h 1 -s 4 --seeds 4 one.pfm box.obj | untimed

# a signal before four seeds
sh -c 'sleep 0.7; kill -INT "$(cat pid)"' &
sh -c 'echo $$ >pid; exec glim "$@"' glim reference -s 1000000000 \
    none.pfm box.obj 2>&1
echo "exit $?"
wait

# wrong calls
run reference
run reference ref.pfm
run reference ref.png box.obj
run reference ref.hdr box.obj
run reference - box.obj
run reference -o ref.pfm box.obj
run reference --seeds 3 ref.pfm box.obj
run reference --seeds 65 ref.pfm box.obj
run reference --seeds 4 --seed 4294967293 ref.pfm box.obj
run reference none/ref.pfm box.obj
run reference ref.pfm none.obj
mkdir folder.json
run reference folder.pfm box.obj
run reference -w 65536 -h 65536 ref.pfm box.obj | cut -c 1-40
run reference --stats a.json ref.pfm box.obj
run -b --seeds 4 box.obj
printf 'sky sky.pfm\n' >sky.view
printf 'Pf\n1 1\n-1\n\0\0\200\77' >sky.pfm
run reference -c sky.view sky.pfm box.obj
ls *.pfm
