# SPDX-License-Identifier: MIT
# After a kill at any time the checkpoint is a whole film, and a render of many
# kills has the bytes of one without.
take box
b="-b -w 96 -h 72 -s 64 -t 1 --checkpoint c.film --checkpoint-interval 0.1"
begin=$(date +%s%N)
glim $b -o whole.png box.obj 2>/dev/null
took_us=$((($(date +%s%N) - begin) / 1000))
rm c.film

# each run has a part of the time that the whole render takes
seed=7
killed=0
while [ $killed -lt 40 ]; do
    seed=$(((seed * 1103515245 + 12345) % 2147483648))
    moment_us=$((100000 + took_us * (seed / 65536 % 100) / 200))
    timeout --foreground -s KILL $(printf %d.%06d $((moment_us / 1000000)) \
        $((moment_us % 1000000))) \
        glim $b --resume c.film -o out.png box.obj 2>/dev/null && {
        [ $killed = 0 ] && [ $took_us -gt 10000 ] || break
        took_us=$((took_us / 2)) # the machine was slower then
        rm -f c.film
        continue
    }
    killed=$((killed + 1))
    [ ! -f c.film ] || glim info c.film >/dev/null || break
done 2>/dev/null
[ $killed -gt 0 ] && echo killed
run_untimed $b --resume c.film -o out.png box.obj
same out.png whole.png
ls -A | grep -v '^box' | sort

# signals leave a film of all samples so far
rm c.film
for signal in INT TERM HUP; do
    timeout --foreground -s $signal 0.6 glim -b -s 100000 -w 96 -h 72 \
        --checkpoint c.film -o x.png box.obj 2>/dev/null
    glim info c.film >/dev/null && echo "$signal: a film"
    rm -f c.film
done

# a full disk is said once, and the last good file stays
cat >fill.sh <<'SH'
mount -t tmpfs -o size=1m none disk 2>/dev/null
is_own=$?
glim -b -w 96 -h 72 -s 4 -o x.png --checkpoint disk/c.film box.obj 2>/dev/null
cp disk/c.film good.film
if [ $is_own = 0 ]; then
    head -c 2000000 /dev/zero >disk/fill 2>/dev/null
else
    trap '' XFSZ
    ulimit -f 64
fi
rm x.png
glim -b -w 96 -h 72 -s 400 --resume disk/c.film --checkpoint disk/c.film \
    --checkpoint-interval 0.1 -o x.png box.obj 2>&1 |
    sed 's/No space left on device/full/; s/File too large/full/' | untimed
cmp good.film disk/c.film && ls -A disk | grep -v fill
SH
mkdir disk
unshare -m true 2>/dev/null && own='unshare -m' || own=
$own sh -c '. "$CLI/lib.sh"; . ./fill.sh'
kind x.png

# what cannot be written at the end is named, and the other files are written
for outputs in '--film f.film -o p.pfm' '--film gone/f.film -o p.pfm' \
    '--film gone/f.film -o gone/p.pfm'; do
    mkdir gone
    glim -b -s 100000 -w 96 -h 72 --checkpoint gone/c.film \
        --checkpoint-interval 0.1 $outputs box.obj 2>said &
    until [ -f gone/c.film ]; do sleep 0.05; done
    mv gone went
    kill -TERM $!
    wait $!
    echo "exit $?"
    grep '^glim: [^w]' said
    rm -r went
done
kind p.pfm
glim info f.film | grep -o picture.*
