#!/bin/sh
# SPDX-License-Identifier: MIT
# cost.sh - instructions a sample of whole renders beside those of
# instructions.txt, so that a loss shows on the day when it happens
#
# usage: cost.sh GLIM [renew]
#
# Counts tracing, the film and its error on one thread, but not loading.
# valgrind supports AVX2 at most. Counts repeat to the last digit with one
# compiler; other compilers differ by some per cent. `renew` writes the file:
# do so with the commit that changes a cost, and say there why.
set -eu
glim=$1
renew=${2:-}
recorded=$(dirname "$0")/instructions.txt
compiler=$("${CC:-cc}" -dumpfullversion 2>/dev/null || echo unknown)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# instructions SCENE: prints instructions a sample
instructions() {
    valgrind --tool=callgrind --toggle-collect=render_block \
        --toggle-collect=add_row_of_tiles --callgrind-out-file=/dev/null \
        --log-file="$work/log" "$glim" -b -t 1 -w 64 -h 36 -s 16 \
        --stats "$work/stats" -o "$work/picture.pfm" "$1" 2>"$work/messages"
    n=$(sed -n 's/.*"samples": *\([0-9]*\).*/\1/p' "$work/stats")
    all=$(sed -n 's/.*Collected : *//p' "$work/log")
    echo $((all / n))
}

if ! command -v valgrind >/dev/null; then
    echo 'cost: skipped: no valgrind here'
    exit 0
fi
echo "# Instructions a sample, gcc $compiler; make bench FILTER=cost RENEW=1" \
    >"$work/new"
printf '%-28s %12s %9s %7s\n' 'instructions a sample' recorded now ratio
for scene in cornell.obj lights200.obj skylit.obj glass_mirror.obj \
    materials.obj interior.obj fog.obj busts.glb prism.obj; do
    scene=scenes/$scene
    now=$(instructions "$scene")
    then=$(awk -v s="$scene" '$1 == s { print $2 }' "$recorded" 2>/dev/null || :)
    printf '%s %s\n' "$scene" "$now" >>"$work/new"
    printf '%-28s %12s %9s %7s\n' "$scene" "${then:--}" "$now" \
        "$(awk "BEGIN { if (${then:-0}) printf \"%.3f\", $now / ${then:-1} }")"
done
if [ "$renew" = renew ]; then
    cp "$work/new" "$recorded"
elif ! grep -qs "gcc $compiler;" "$recorded"; then
    echo "$recorded is not by gcc $compiler"
fi
