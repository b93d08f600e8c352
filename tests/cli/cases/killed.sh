# SPDX-License-Identifier: MIT
# After a kill at any time there is the complete old or new picture, and no
# other file, or one that the next save removes.
take box
b="-b -w 96 -h 72 -s 1 -t 1"
glim $b --seed 1 -o old.pfm box.obj 2>/dev/null
begin=$(date +%s%N)
glim $b --seed 2 -o new.pfm box.obj 2>/dev/null
took_us=$((($(date +%s%N) - begin) / 1000))

# unnamed files are supported here; elsewhere some files stay until the next
# save
mkdir out
case $(stat -f -c %T out) in
ext* | xfs | btrfs | tmpfs) all='out/* out/.glim-*' ;;
*) all='out/*' ;;
esac

whole()
{
    cmp -s "$1" old.pfm || cmp -s "$1" new.pfm || echo "$1 is torn"
}

# 200 moments over the time of a run; fewer for a slow program
kills=$((80000000 / took_us))
[ $kills -le 200 ] || kills=200
for i in $(seq $kills); do
    [ $((i % 2)) = 0 ] || cp old.pfm out/out.pfm
    [ $((i % 4)) != 2 ] || rm -f out/out.pfm
    moment_us=$((took_us * i * 11 / kills / 10))
    # in the foreground timeout waits until the process has ended
    timeout --foreground -s KILL $(printf %d.%06d $((moment_us / 1000000)) \
        $((moment_us % 1000000))) \
        glim $b --seed 2 -o out/out.pfm box.obj 2>/dev/null
    for file in $all; do
        [ ! -f "$file" ] || whole "$file"
    done
done 2>/dev/null
run_untimed $b --seed 2 -o out/out.pfm box.obj
ls -A out
same out/out.pfm new.pfm
