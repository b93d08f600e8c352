#!/bin/bash
# SPDX-License-Identifier: MIT
# mpi.sh - the speed of ranks (`make bench-mpi`)
#
# usage: mpi.sh GLIM
#
# Renders scenes with one rank and with two ranks of one thread each, in turn,
# and prints the medians of samples a second and their ratio. Then it prints what
# the exchange of films costs: processor time of a scene without faces, where
# there is little else to do, with two ranks less that with one.
# From these it computes a table for many ranks.
set -u
cd "$(dirname "$0")/../.." || exit 1
mpi=$1
rounds=${ROUNDS:-3}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
command -v mpirun >/dev/null || { echo 'bench-mpi: no mpirun'; exit 1; }

# Prints a number of the statistics.
of() # KEY RANKS OPTION...
{
    local key=$1 ranks=$2

    shift 2
    mpirun --oversubscribe -n "$ranks" "$mpi" -b -t 1 --stats "$work/stats" \
        -o "$work/x.pfm" "$@" >"$work/said" 2>&1 || cat "$work/said" >&2
    sed -n "s/^ *\"$key\": \([0-9.e+]*\).*/\1/p" "$work/stats"
}

median()
{
    sort -g | awk '{ n[NR] = $1 } END { print n[int((NR + 1) / 2)] }'
}

echo 'scene            spp  samples/s: 1 rank    2 ranks    ratio'
for scene in cornell interior materials; do
    for spp in 64 256; do
        rm -f "$work/1" "$work/2"
        for _ in $(seq "$rounds"); do
            for ranks in 1 2; do
                of samples_per_s $ranks -w 512 -h 288 -s $spp \
                    "scenes/$scene.obj" >>"$work/$ranks"
            done
        done
        one=$(median <"$work/1")
        two=$(median <"$work/2")
        echo "$scene $spp $one $two" | awk '{ printf "%-15s %5d %18.0f %10.0f %8.2f\n", $1, $2, $3, $4, $4 / $3 }'
    done
done

printf 'v 0 0 0\n' >"$work/empty.obj"
printf 'background 1 1 1\neye 0 0 1\nat 0 0 0\n' >"$work/empty.view"
pixels=589824 # of 1024x576
passes=9      # to 1, 2, 4, 8, 16, 32, 64, 96, 128 samples
TIMEFORMAT='%U %S'
# Prints the processor seconds of samples 2 to 128.
cpu() # RANKS
{
    local spp

    for _ in $(seq "$rounds"); do
        for spp in 128 1; do
            { time of spp "$1" -w 1024 -h 576 -s $spp "$work/empty.obj" \
                >"$work/spp"; } 2>&1
        done | awk '{ t[NR] = $1 + $2 } END { print t[1] - t[2] }'
    done | median
}
alone=$(cpu 1)
both=$(cpu 2)
echo "empty, 1024x576, 128 spp: processor $alone s with 1 rank, $both s with 2"
# a worker sends half of the pixels
exchange=$(echo "$alone $both $passes $pixels" |
    awk '{ print 1e9 * ($2 - $1) / $3 / ($4 / 2) }')
echo "packing, sending and adding: $exchange ns a pixel of a worker"

# The share of the time in which ranks of 16 threads render 1920x1080 pixels.
# A pass has 16 samples for each rank, and so many slices that each rank has 8
# bands of 2 rows (src/render/cluster/band_plan.c). Rank 0 receives and adds the slices
# with one thread, which is taken as the whole cost above, 45 bytes a pixel come
# over 10 Gbit/s, and ranks wait for half a last band. Rendering, adding and the
# line overlap.
rate=$(of samples_per_s 1 -w 512 -h 288 -s 64 scenes/cornell.obj)
echo "ranks of 16 threads, each of $rate samples/s, 1920x1080 pixels:"
echo "$exchange $rate" | awk '{
    pixels = 1920 * 1080; speed = 16 * $2
    for (ranks = 16; ranks <= 4096; ranks *= 16) {
        slices = int((8 * ranks + 539) / 540)
        render = pixels * 16 / speed
        adding = slices * pixels * $1 * 1e-9
        line = slices * pixels * 45 * 8 / 1e10
        band = 1920 * 2 * 16 * ranks / slices / speed
        time = render
        if (adding > time) time = adding
        if (line > time) time = line
        time += band / 2
        printf "%5d ranks: pass %.2f s: render %.2f, add %.2f, line %.2f, wait %.2f: busy %.0f %%\n",
            ranks, time, render, adding, line, band / 2, 100 * render / time
    }
}'
