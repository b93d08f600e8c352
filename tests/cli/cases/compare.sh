# SPDX-License-Identifier: MIT
# glim compare: the errors, the tiles that differ, and every wrong call.

# Writes a PFM file of $2 x $3 pixels with the floats of the octal bytes $4 in
# every channel but the last value, which is $5.
pfm()
{
    printf 'PF\n%d %d\n-1.0\n' "$2" "$3" >"$1"
    for i in $(seq $(($2 * $3 * 3 - 1))); do
        printf "$4"
    done >>"$1"
    printf "$5" >>"$1"
}

one='\000\000\200\077'
half='\000\000\000\077'
pfm a.pfm 32 32 "$one" "$one"
pfm b.pfm 32 32 "$one" "$half"
pfm half.pfm 32 32 "$half" "$half"
pfm black.pfm 1 1 '\000\000\000\000' '\000\000\000\000'
pfm dot.pfm 1 1 "$one" "$half"
pfm nan.pfm 32 32 "$one" '\000\000\300\177'
pfm minus.pfm 32 32 "$one" '\000\000\200\277'
run compare a.pfm a.pfm
# rows of PFM come from the bottom, so the last value is in row 0
run compare b.pfm a.pfm
run compare half.pfm a.pfm --tiles 1 -o d.png
kind d.png
run compare --tiles=2 half.pfm a.pfm -o d.pfm
floats d.pfm 32 32 | sort -u
run compare dot.pfm dot.pfm
run compare dot.pfm black.pfm
# the reference's own error
echo '{"mse": 1e-5, "relmse": 4.5e-5}' >a.json
run compare b.pfm a.pfm | head -3
echo '{"mse": 1, "relmse": 1}' >a.json
run compare b.pfm a.pfm | head -3
echo 'no object' >a.json
run compare b.pfm a.pfm | head -3
run compare minus.pfm a.pfm | head -2

# renders of two seeds, and one that is brighter
take box
glim -b -w 64 -h 64 -s 16 -o s0.pfm box.obj 2>/dev/null
glim -b -w 64 -h 64 -s 16 --seed 1 -o s1.pfm box.obj 2>/dev/null
sed 's/Ke .*/Ke 13 13 13/' box.mtl >lit.mtl
sed 's/box.mtl/lit.mtl/' box.obj >lit.obj
glim -b -w 64 -h 64 -s 16 -c box.view --seed 2 -o lit.pfm lit.obj 2>/dev/null
glim compare s0.pfm s1.pfm | tail -1
glim compare lit.pfm s1.pfm >text
echo "exit $?"

# a scene called compare
cp box.obj compare
run_untimed -b -c box.view -s 1 -o c.png ./compare
run_untimed -b -c box.view -s 1 -o c.png -- compare

# wrong calls
run compare
run compare a.pfm
run compare a.pfm b.pfm black.pfm
run compare a.pfm dot.pfm
run compare a.pfm none.pfm
run compare nan.pfm a.pfm
run compare a.pfm nan.pfm
run compare a.pfm box.mtl
run compare -w 3 a.pfm b.pfm
run compare a.pfm b.pfm --tiles 0
run compare a.pfm b.pfm --tiles 257
run compare a.pfm b.pfm --false-alarms 0
run compare a.pfm b.pfm --false-alarms often
run compare a.pfm b.pfm -o d.hdr
run compare a.pfm b.pfm -o -
run compare a.pfm b.pfm -o d.jpg
run compare a.pfm b.pfm -o ./a.pfm
run compare a.pfm b.pfm -o none/d.png
run -b --tiles 4 box.obj
if [ -e /dev/full ]; then
    glim compare a.pfm a.pfm 2>&1 >/dev/full
    echo "exit $?"
fi
glim compare --help | head -1
