#!/bin/bash
# SPDX-License-Identifier: MIT
# mpi.sh - the speed of ranks (`make bench-mpi`)
#
# usage: mpi.sh GLIM
#
# Renders scenes with one rank and with two ranks of one thread each, in turn,
# and prints the medians of samples a second and their ratio. Then it prints what
# the exchange of a film costs: the time of passes of a scene without faces,
# where there is little else to do, with two ranks less that with one.
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
passes=16 # of 8 samples, and shorter ones before
one=$(for _ in $(seq "$rounds"); do
    of total_s 1 -w 1024 -h 576 -s 128 "$work/empty.obj"
done | median)
two=$(for _ in $(seq "$rounds"); do
    of total_s 2 -w 1024 -h 576 -s 128 "$work/empty.obj"
done | median)
echo "empty, 1024x576, 128 spp: $one s with 1 rank, $two s with 2"
echo "$one $two $passes" | awk '{ printf "exchange of a film of 1024x576: at most %.1f ms a pass\n", 1000 * ($2 - $1 / 2) / $3 }'
