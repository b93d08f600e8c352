#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh - compares glim with Blender's Cycles (`make bench-cycles`)
#
# Measures camera paths per second of both, in turns, on the scenes of
# ../shared/scenes-bench, and the ratio of the variances at equal time. BUILD is
# the folder of the program, FILTER a scene, ROUNDS the number of runs for
# medians.
set -eu
build=${BUILD:-build/release}
shared=${GLIM_SHARED:-../shared}/scenes-bench
rounds=${ROUNDS:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

missing() {
    echo "skip bench-cycles: no $1"
    exit 0
}

median() { # COLUMN FILE
    cut -d ' ' -f "$1" "$work/$2" | sort -g | awk '{ v[NR] = $1 }
        END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'
}

# cycles and glim print millions of paths per second, by the clock and by
# processor time of one thread, which other programs hardly disturb.

noise() { # prefix of its two pictures
    python3 tests/bench/cycles/noise.py "$work/$1"0.pfm "$work/$1"1.pfm
}

# Measures between 4 and 36 samples per pixel, which excludes the start.
cycles() { # OBJ THREADS
    blender -b --factory-startup -P tests/bench/cycles/cycles.py -- "$1" "$2" \
        "$work/cycles" 4 36 2>"$work/log" | awk '$1 == "cycles" { s[$2] = $3; busy[$2] = $4 }
        END { n = 32 * 256 * 256 / 1e6
            print n / (s[36] - s[4]), n / (busy[36] - busy[4]) }'
}

# Includes loading, which takes milliseconds.
glim() { # OBJ THREADS SEED
    (
        "$build/glim" -b -c "$work/view" -d 64 -s 128 -t "$2" --seed "$3" \
            --stats "$work/stats" -o "$work/glim$3.pfm" "$1" 2>"$work/log"
        times >"$work/times"
    )
    sed -n 's/.*"render_s": \([0-9.]*\).*/\1/p' "$work/stats" |
        tr 'ms\n' '   ' | cat - "$work/times" | tr 'ms\n' '   ' |
        awk '{ n = 128 * 256 * 256 / 1e6
            print n / $1, n / (60 * ($6 + $8) + $7 + $9) }'
}

command -v blender >/dev/null || missing 'blender (Debian: blender)'
[ -d "$shared" ] || missing "$shared"
sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1
echo "load $(cut -d ' ' -f 1-3 /proc/loadavg); medians of $rounds"
echo '                      Mpaths/s by the clock         by the processor     less'
echo 'scene        threads  Cycles  glim  ratio   Cycles  glim  ratio    noise'
for scene in cornell many_lights sky; do
    case $scene in *"${FILTER:-}"*) ;; *) continue ;; esac
    obj=$shared/$scene/$scene.obj
    grep -v max_bounces "$shared/$scene/camera.txt" >"$work/view"
    for threads in 1 $(nproc); do
        : >"$work/cycles"
        : >"$work/glim"
        i=0
        while [ "$i" -lt "$rounds" ]; do
            cycles "$obj" "$threads" >>"$work/cycles"
            glim "$obj" "$threads" 0 >>"$work/glim"
            i=$((i + 1))
        done
        glim "$obj" "$threads" 1 >/dev/null
        echo "$scene $threads $(median 1 cycles) $(median 1 glim)" \
            "$(median 2 cycles) $(median 2 glim) $(noise cycles) $(noise glim)" |
            awk '{ printf "%-12s %7d %7.2f %5.2f %6.2f %8.2f %5.2f %6.2f %8.2f\n",
                $1, $2, $3, $4, $4 / $3, $5, $6, $6 / $5,
                $7 * 36 / $5 / ($8 * 128 / $6) }'
    done
done
