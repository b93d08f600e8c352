#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh - measures speed (`make bench`)
#
# BUILD is the folder of the program; FILTER selects one measurement. Times
# depend on the machine and its load: compare ratios.
set -eu
build=${BUILD:-build/release}
filter=${FILTER:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

wanted() {
    [ -z "$filter" ] || [ "$filter" = "$1" ]
}

# render THREADS NAME SCENE ARGUMENTS...: prints seconds of rendering and writes
# NAME.json
render() {
    threads=$1 name=$2 scene=$3
    shift 3
    "$build/glim" -b -t "$threads" --stats "$work/$name.json" \
        -o "$work/$name.pfm" "$@" "$scene" 2>"$work/$name.log"
}

value() { # KEY FILE
    sed -n "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/p" "$work/$2.json"
}

divide() { # A B
    awk "BEGIN { printf \"%.3f\", $1 / $2 }"
}

machine() {
    sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1
    echo "cores: $(nproc), load: $(cut -d ' ' -f 1-3 /proc/loadavg)"
}

# Measures one process with 1 to all threads, 960x544, 32 spp.
bench_threads() {
    echo
    echo 'threads: scenes/cornell.obj, 960x544, 32 spp'
    echo 'threads  seconds  Msamples/s  speed-up'
    n=1
    while [ "$n" -le "$(nproc)" ]; do
        render "$n" threads scenes/cornell.obj -w 960 -h 544 -s 32
        s=$(value render_s threads)
        [ "$n" -gt 1 ] || one=$s
        printf '%7d %8s %11s %9s\n' "$n" "$s" \
            "$(divide "$(value samples threads)" "($s * 1e6)")" \
            "$(divide "$one" "$s")"
        n=$((n + 1))
    done
}

# Measures the cost of sharing: all threads in one process against as many
# processes of one thread, each of which renders its part of the picture.
bench_sharing() {
    n=$(nproc)
    echo
    echo "sharing: one process of $n threads against $n of one, 960x544, 32 spp"
    for round in 1 2 3 4 5; do
        render "$n" together scenes/cornell.obj -w 960 -h 544 -s 32
        i=0
        pids=
        while [ "$i" -lt "$n" ]; do
            render 1 "apart$i" scenes/cornell.obj -w 960 -h 544 -s 32 &
            pids="$pids $!"
            i=$((i + 1))
        done
        for pid in $pids; do
            wait "$pid"
        done
        rate=0
        i=0
        while [ "$i" -lt "$n" ]; do
            rate=$(awk "BEGIN { print $rate + 1 / $(value render_s "apart$i") }")
            i=$((i + 1))
        done
        ratio=$(awk "BEGIN { printf \"%.3f\", \
            1 / $(value render_s together) / $rate }")
        echo "round $round: together/apart $ratio"
    done
}

scenes() {
    ls scenes/*.obj
    for scene in bunny sponza_part; do
        ls "../shared/scenes-real/$scene/$scene.obj" 2>/dev/null || :
    done
}

# Measures whole renders, and the gain of kernels without unused features.
bench_builds() {
    echo
    echo 'builds: 480x270, 4 spp, a core, medians of 5'
    # shellcheck disable=SC2046 # names without spaces
    "$build/bench/builds" $(scenes)
}

# instructions BUILD SCENE: prints instructions per sample by valgrind, which
# supports AVX2 at most; those of probes while the scene is loaded do not count
instructions() {
    n=$(valgrind --tool=callgrind --toggle-collect=render_block \
        --callgrind-out-file=/dev/null --log-file="$work/valgrind.log" \
        "$build/bench/builds" --once "$1" "$2")
    all=$(sed -n 's/.*Collected : *//p' "$work/valgrind.log")
    echo $((all / n))
}

# Counts the instructions that specialised builds save.
bench_instructions() {
    echo
    if ! command -v valgrind >/dev/null; then
        echo 'instructions: skipped: no valgrind here'
        return 0
    fi
    printf '%-50s %9s %9s\n' 'instructions a sample' whole own
    for scene in $(scenes); do
        printf '%-50s %9s %9s\n' "$scene" "$(instructions whole "$scene")" \
            "$(instructions own "$scene")"
    done
}

# Compares instructions a sample with recorded ones.
bench_cost() {
    echo
    tests/bench/cost.sh "$build/glim" ${RENEW:+renew}
}

# Compares the time of a sample with that of the commit AGAINST, in turns.
bench_turns() {
    [ -z "${AGAINST:-}" ] || {
        echo
        tests/bench/turns.sh "$build/glim" "$AGAINST"
    }
}

# Measures samples per pixel at 60 pictures per second.
bench_frames() {
    echo
    echo "frames: samples a pixel that fit into 16.7 ms, $(nproc) threads"
    "$build/bench/frames" scenes/cornell.obj scenes/interior.obj
}

halts() { # ARGUMENTS for each scene
    for scene in scenes/cornell.obj scenes/interior.obj \
        ../shared/scenes-real/sponza_part/sponza_part.obj; do
        [ ! -e "$scene" ] || "$build/bench/halts" "$scene" "$@"
    done
}

bench_halts() {
    echo
    echo 'halts: from the request until every worker is parked'
    halts 1000
}

# Compares OpenCL with the CPU: speed, halting, the first and a later start.
bench_device() {
    echo
    echo 'device: OpenCL against the CPU, 480x270, 4 spp, medians of 5'
    if ! "$build/glim" --list-devices; then
        return 0
    fi
    for n in 1 $(nproc); do
        "$build/bench/device" "$n" scenes/cornell.obj scenes/materials.obj \
            scenes/glass_mirror.obj scenes/interior.obj scenes/skylit.obj \
            scenes/lights200.obj
    done
    halts 1000 opencl
    for start in cold warm warm; do
        POCL_CACHE_DIR="$work/pocl" "$build/glim" -b --backend opencl -s 1 \
            -w 64 -h 36 --stats "$work/start.json" -o "$work/start.pfm" \
            scenes/cornell.obj 2>"$work/start.log"
        echo "$start start: first picture after $(value first_picture_s start) s"
    done
}

# Measures frames of the preview while the camera moves.
bench_previews() {
    echo
    echo 'previews: 200x60 cells, all threads'
    for scene in scenes/cornell.obj scenes/glass_mirror.obj \
        scenes/interior.obj scenes/lights200.obj scenes/materials.obj \
        scenes/skylit.obj; do
        "$build/bench/previews" "$scene"
    done
}

# Measures the conversion of a film to the screen's pixels.
bench_screens() {
    echo
    echo 'screens: a film of 1920x1080 pixels in 200x60 cells, one thread'
    "$build/bench/screens"
}

# Measures frames of live mode with the filter.
bench_filters() {
    echo
    echo 'filters: frames of a screen, one thread'
    "$build/bench/filters" scenes/cornell.obj scenes/interior.obj
}

# first_picture SCENE: prints the least of ten times from the start of the
# program to the first picture
first_picture() {
    for round in 1 2 3 4 5 6 7 8 9 10; do
        render "$(nproc)" first "$1" -w 200 -h 120 -s 1
        value first_picture_s first
    done | sort -n | head -n 1
}

# Measures loading: a million triangles of text and of binary data.
bench_load() {
    echo
    echo 'load: a grid of 1,000,000 triangles'
    "$build/bench/grid" 1000 500 >"$work/grid.obj"
    bytes=$(wc -c <"$work/grid.obj")
    render "$(nproc)" load "$work/grid.obj" -w 64 -h 36 -s 1
    echo "load_s $(value load_s load) ($(divide "$bytes" \
        "($(value load_s load) * 1e6)") MB/s with textures and clean-up)," \
        "build_s $(value build_s load)"
    for format in ply stl glb; do
        "$build/bench/grid" 1000 500 "$format" >"$work/grid.$format"
    done
    "$build/bench/loads" "$work/grid.obj" "$work/grid.ply" "$work/grid.stl" \
        "$work/grid.glb"
    for scene in "$work"/grid.* scenes/cornell.obj; do
        echo "$scene: first picture after $(first_picture "$scene") s"
    done
}

bench_sampling() {
    echo
    echo 'sampling: nanoseconds on one core'
    "$build/bench/sampling"
}

# Measures the cost of a ray by the number of triangles.
bench_triangles() {
    echo
    "$build/rays/scaling"
}

machine
for name in cost turns builds instructions frames threads sharing halts previews screens filters load device sampling triangles; do
    if wanted "$name"; then
        "bench_$name"
    fi
done
