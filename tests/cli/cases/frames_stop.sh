# SPDX-License-Identifier: MIT
# A signal keeps the pictures that are finished; a full disk ends a series.
take box
stop_after_two()
{
    until [ -e out-0001.png ]; do
        sleep 0.01
    done
    kill -s TERM "$(cat pid)"
}
stop_after_two &
sh -c 'echo $$ >pid; exec glim "$@"' glim -b -w 96 -h 64 -s 16 \
    --turntable 1000000 -o out.png box.obj 2>err
echo "exit $?"
wait
count=$(ls out-*.png | wc -l)
tail -n 1 err | sed "s/after $count of/after COUNT of/"
ls -A | grep -v '^out-.*\.png$'

mkdir disk
cat >fill.sh <<'SH'
if ! mount -t tmpfs -o size=64k none disk 2>/dev/null; then
    trap '' XFSZ
    ulimit -f 16
fi
glim -b -w 48 -h 36 -s 1 --turntable 8 -o disk/a.pfm box.obj 2>err
echo "exit $?"
tail -n 1 err | sed 's/-000[0-9]/-N/; s/No space left on device/full/
    s/File too large/full/'
SH
unshare -m true 2>/dev/null && own='unshare -m' || own=
$own sh fill.sh
