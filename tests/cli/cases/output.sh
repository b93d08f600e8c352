# SPDX-License-Identifier: MIT
# Output that cannot be written is reported, before the render if possible.
take box
b="-b -w 8 -h 4 -s 1000000000"
mkdir folder.png
run $b -o folder.png box.obj
run $b -o none/out.png box.obj
run $b -o out.png --stats none/x.json box.obj
run $b -o out.png --stats folder.png box.obj
run $b -o out.png --stats /dev/null box.obj
glim -b -w 8 -h 4 -s 1 -o - box.obj >&- 2>err
echo "exit $?"
cat err
if [ -e /dev/full ]; then
    glim -b -w 8 -h 4 -s 1 -o - box.obj >/dev/full 2>err
    echo "exit $?"
    cat err
fi
echo 'what is read is not written over, whatever its name is:'
ln -s box.mtl link.png
run $b -o link.png box.obj
run $b -o out.png --stats box.obj box.obj
run -b --ansi 8x4 -o ./box.view box.obj
run $b -o out.png --stats out.png box.obj
run $b -o out.png --stats ./out.png box.obj
run $b -o folder.png/../out.png --stats "$PWD/out.png" box.obj |
    sed "s|$PWD|HERE|"
ln -s out.png other.json
run $b -o out.png --stats other.json box.obj
rm other.json
run_untimed -b -w 8 -h 4 -s 1 --stats box.png box.obj
kind box.png
rm box.png
head -n 1 box.obj box.mtl
rm link.png
echo 'no room: the old picture stays'
echo old >out.pfm
(
    ulimit -f 4
    run -b -w 100 -h 100 -s 1 -o out.pfm box.obj
)
cat out.pfm
ls -A
