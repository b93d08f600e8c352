# SPDX-License-Identifier: MIT
# On a full disk the old file stays, one message says so, and no other file is
# left.
take box
mkdir disk
cat >fill.sh <<'SH'
# uses a disk of its own if that is allowed, otherwise a limit of 8 KB for files
if ! mount -t tmpfs -o size=16k none disk 2>/dev/null; then
    trap '' XFSZ
    ulimit -f 16
fi
echo old >disk/a.pfm
for name in a.pfm b.png; do
    glim -b -w 192 -h 144 -s 1 -o disk/$name box.obj 2>&1
    echo "exit $?"
done | sed 's/No space left on device/full/; s/File too large/full/'
cat disk/a.pfm
ls -A disk
# A reference whose JSON file does not fit keeps none of an older picture.
rm disk/*
glim reference -w 8 -h 8 -s 4 --seeds 4 disk/r.pfm box.obj 2>/dev/null
ls -A disk
glim reference -w 8 -h 8 -s 4 --seeds 4 $(printf -- '--exposure=0 %.0s' \
    $(seq 2000)) disk/r.pfm box.obj 2>&1 |
    sed 's/No space left on device/full/; s/File too large/full/'
ls -A disk
SH
unshare -m true 2>/dev/null && own='unshare -m' || own=
$own sh fill.sh
