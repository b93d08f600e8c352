# SPDX-License-Identifier: MIT
# A film of another picture, or a damaged one, is refused with a line that names
# what is wrong, and files stay.
take box
b="-b -w 24 -h 18 -s 8"
glim $b --film a.film -o a.png box.obj 2>/dev/null

refused()
{
    run $b --resume a.film --film b.film -o b.png "$@"
}

refused --seed 1 box.obj
refused -w 25 box.obj
refused -d 3 box.obj
refused --adaptive box.obj
refused --denoise box.obj
refused --crop 0,0,8,8 box.obj
refused --share 2/2 box.obj
(cat box.obj; echo 'v 9 9 9'; echo 'f -1 1 2') >moved.obj
cp box.view moved.view
refused moved.obj
cp box.obj red.obj
cp box.view red.view
sed 's/^mtllib.*/mtllib red.mtl/' box.obj >red.obj
sed 's/^Kd [0-9.]*/Kd 0.123/' box.mtl >red.mtl
refused red.obj
cp box.obj lit.obj
(cat box.view; echo background 0.5 0.5 0.5) >lit.view
refused lit.obj

for name in empty cut long broken other none; do
    case $name in
    empty) : >x.film ;;
    cut) head -c 1000 a.film >x.film ;;
    long) (cat a.film; echo) >x.film ;;
    broken) sed 's/^seed 0/seed 1/' a.film >x.film ;;
    other) cp a.png x.film ;;
    none) rm x.film ;;
    esac
    run $b --resume x.film -o b.png box.obj |
        sed 's/checksum [0-9a-f]*, expected [0-9a-f]*/checksum X, expected Y/'
done
run info a.film | head -n 4
run info x.film
ls b.png b.film 2>&1 | sort

glim $b --share 1/2 --film 1.film -o x.png box.obj 2>/dev/null
glim $b --share 2/2 --film 2.film -o x.png box.obj 2>/dev/null
glim $b --share 2/2 --seed 1 --film 3.film -o x.png box.obj 2>/dev/null
glim $b --adaptive --film 4.film -o x.png box.obj 2>/dev/null
run merge -o m.png 1.film 3.film
run merge -o m.png 1.film 2.film 1.film
run merge -o m.png 4.film 4.film
run merge -o 2.film 1.film 2.film
run merge -o m.bmp 1.film
run merge -o m.png
run merge 1.film
run info
run develop -o m.png 1.film 2.film
run develop --denoise -o m.png 1.film
run_untimed merge -o m.png 2.film

run $b --share 2/9 --film x.film box.obj
run $b --share 9/8 --film x.film box.obj
run $b --share 1 --film x.film box.obj
run $b --share 1/2 box.obj
run -b -e 1% --share 1/2 --film x.film box.obj
run -b --share 1/2 --film x.film box.obj
run $b --checkpoint-interval 5 box.obj
run $b --checkpoint-interval 0 --checkpoint x.film box.obj
run $b --film - box.obj
run $b --film box.obj box.obj
run $b --film no/x.film box.obj
run --film x.film box.obj
ls *.film
