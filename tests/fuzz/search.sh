#!/bin/bash
# SPDX-License-Identifier: MIT
# search.sh - runs each fuzz target with random inputs (`make fuzz`)
#
# BUILD is the folder of the targets, TIME the seconds for each of them and RUNS
# the inputs, whichever ends first; FILTER=PART selects some by name. Inputs that
# reach new code are kept in build/fuzz/NAME for the next time, failing ones in
# build/fuzz/found. Each input has a minute and 2 GiB. A line says how many inputs
# a target had, how many in a second, and libFuzzer's counts of edges (cov) and
# features (ft). The last line is "N passed, N failed".
set -u
cd "$(dirname "$0")/../.." || exit 1
shared=${GLIM_SHARED:-../shared}/suites
work=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir -p build/fuzz/found
export TMPDIR=$work
export LSAN_OPTIONS=suppressions=$PWD/tests/tools/lsan.supp:print_suppressions=0
limits=()
[ -n "${TIME-}" ] && limits+=("-max_total_time=$TIME")
[ -n "${RUNS-}" ] && limits+=("-runs=$RUNS")
passed=0
failed=0

# Copies files with these endings as first inputs of the target.
seeds() # NAME ENDING...
{
    local ending

    mkdir -p "$work/$1"
    for ending in "${@:2}"; do
        [ -d "$shared" ] && find "$shared" -name "*.$ending" -size -64k \
            -exec cp --backup=numbered -t "$work/$1" {} +
    done
}

search() # NAME
{
    local name=$1

    case $name in
    obj | scene) seeds "$name" obj ;;
    mtl) seeds mtl mtl ;;
    gltf) seeds gltf gltf glb ;;
    ply) seeds ply ply ;;
    stl) seeds stl stl STL ;;
    view) seeds view view ;;
    image) seeds image png jpg tga ;;
    *) seeds "$name" ;;
    esac
    mkdir -p "build/fuzz/$name"
    if nice "$BUILD/fuzz/fuzz_$name" "${limits[@]}" \
        -timeout=60 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
        -artifact_prefix="build/fuzz/found/$name-" "build/fuzz/$name" \
        "tests/fuzz/corpus/$name" "$work/$name" >"$work/log" 2>&1; then
        passed=$((passed + 1))
        echo "ok $name ($(awk '
            / cov: / { cov = $4; ft = $6 }
            /^stat::number_of_executed_units:/ { runs = $2 }
            /^stat::average_exec_per_sec:/ { speed = $2 }
            END { printf "%d inputs, %d/s, cov %d, ft %d", runs, speed, cov, ft }
        ' "$work/log"))"
    else
        failed=$((failed + 1))
        tail -n 60 "$work/log"
        echo "FAIL $name: reproduce with $BUILD/fuzz/fuzz_$name FILE"
    fi
}

for target in tests/fuzz/fuzz_*.c; do
    name=$(basename "$target" .c)
    name=${name#fuzz_}
    [[ $name == *"${FILTER-}"* ]] && search "$name"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
