#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh - runs checks that take minutes (`make stress`)
#
# BUILD is the folder of the program; FILTER selects one check by name. The last
# line is "N passed, N failed"; a skipped check prints the reason.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build/release}
filter=${FILTER:-}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scenes='cornell materials glass_mirror interior skylit lights200 principled'
passed=0
failed=0

# check NAME COMMAND...: counts one check and shows its output if it fails
check() {
    name=$1
    shift
    if "$@" >"$work/log" 2>&1; then
        echo "ok $name"
        passed=$((passed + 1))
    else
        echo "FAIL $name"
        cat "$work/log"
        failed=$((failed + 1))
    fi
}

wanted() {
    [ -z "$filter" ] || [ "$filter" = "$1" ]
}

missing() { # COMMAND FOR
    command -v "$1" >/dev/null && return 1
    echo "skip $2 (no $1)"
}

# Runs the kernels in a simulator that checks every memory access and data
# races, and compares the picture with the CPU's. The simulator hooks into
# programs that are linked with OpenCL, which glim is not, so it is installed as
# the only driver. The line in which glim names its picture states an error, too.
simulate() { # SCENE
    OCL_ICD_VENDORS=$work/vendors oclgrind --build-options -cl-opt-disable \
        --data-races "$build/glim" -b --backend opencl --device oclgrind \
        -w 16 -h 9 -s 1 --stats "$work/stats" -o "$work/device.pfm" \
        "scenes/$1.obj" 2>"$work/said" &&
        "$build/glim" -b -w 16 -h 9 -s 1 -o "$work/cpu.pfm" "scenes/$1.obj" &&
        cat "$work/said" && grep -q '"backend": "opencl"' "$work/stats" &&
        ! grep -v "^$work/device.pfm: " "$work/said" |
        grep -i -E 'error|race|invalid|warning' &&
        cmp "$work/device.pfm" "$work/cpu.pfm"
}

stress_oclgrind() {
    missing oclgrind oclgrind && return
    mkdir "$work/vendors"
    find / -xdev -name 'liboclgrind-rt-icd.so*' 2>/dev/null | head -n 1 \
        >"$work/vendors/oclgrind.icd"
    for scene in $scenes; do
        check "oclgrind $scene" simulate "$scene"
    done
}

# Runs a command under valgrind, which must find no error and no leak.
checked() # COMMAND...
{
    valgrind -q --error-exitcode=9 --leak-check=full \
        --show-leak-kinds=definite,indirect \
        --errors-for-leak-kinds=definite,indirect --fair-sched=yes \
        --suppressions=tests/stress/drivers.supp "$@"
}

# Checks the host's memory accesses and leaks with valgrind: of the program, with
# a device too, and of unit tests.
stress_valgrind() {
    missing valgrind valgrind && return
    for backend in cpu opencl; do
        check "valgrind $backend" checked "$build/glim" -b \
            --backend "$backend" -w 32 -h 18 -s 2 -o "$work/picture.png" \
            scenes/glass_mirror.obj
    done
    for test in "$build"/unit/*/test_*; do
        [ -x "$test" ] && check "valgrind ${test##*/}" checked "$test"
    done
}

# Runs a command that prints rows and counts them. An exit status other than 0,
# or 1 for failed rows, counts as one more failure.
count_rows() { # NAME COMMAND...
    name=$1
    shift
    echo "-- $name"
    "$@" >"$work/rows"
    status=$?
    grep -E '^(ok|FAIL|skip|--) ' "$work/rows"
    passed=$((passed + $(grep -c '^ok ' "$work/rows")))
    bad=$(grep -c '^FAIL ' "$work/rows")
    if [ "$status" -gt 1 ] || [ "$status" != 0 ] && [ "$bad" = 0 ]; then
        echo "FAIL $name: ended with status $status"
        bad=$((bad + 1))
    fi
    failed=$((failed + bad))
}

rows() { # PROGRAM [ARGUMENT]
    program=$1
    shift
    count_rows "$program${1:+ $1}" "$build/stress/$program" "$@"
}

# Compares materials with Blender's own pictures of them: the installed Blender,
# and the Python that PEER names if it has Blender as a module.
stress_blender() {
    script=tests/stress/blender.py
    mkdir "$work/blender"
    missing blender 'the comparison with Blender' ||
        count_rows blender blender -b --factory-startup -P $script -- \
            "$build/glim" "$work/blender"
    [ -n "${PEER:-}" ] || return
    count_rows blender "$PEER" $script -- "$build/glim" "$work/blender"
}

stress_rays() {
    rows rays "${RAYS:-1}"
}

stress_samples() {
    rows samples
    rows samples opencl
}

# Checks that a picture of this size is written, or that one line reports what
# is wrong with the size. A limit of 2 GiB makes the result independent of the
# machine.
is_right_size() { # WIDTH HEIGHT STATUS [WORDS OF THE LINE]
    rm -f "$work/size.png"
    # shellcheck disable=SC3045 # dash and bash have it
    (ulimit -v 2097152
        "$build/glim" -b -t 1 -w "$1" -h "$2" -s 1 -o "$work/size.png" \
            scenes/cornell.obj 2>"$work/said")
    status=$?
    cat "$work/said"
    [ "$status" = "$3" ] || return 1
    if [ "$status" = 0 ]; then
        [ -s "$work/size.png" ]
    else
        [ "$(wc -l <"$work/said")" = 1 ] && grep -q -e "$4" "$work/said" &&
            [ ! -e "$work/size.png" ]
    fi
}

# Checks the same sizes on an OpenCL device; without one the CPU renders.
is_right_device_size() { # WIDTH HEIGHT
    for backend in cpu opencl; do
        "$build/glim" -b --backend "$backend" -w "$1" -h "$2" -s 1 \
            -o "$work/$backend.pfm" scenes/cornell.obj || return 1
    done
    cmp "$work/cpu.pfm" "$work/opencl.pfm"
}

stress_sizes() {
    case $build in
    *san-*address*)
        echo "skip sizes (the address sanitizer needs more than ulimit -v grants)"
        return
        ;;
    esac
    for size in '1 1 0' '1 37 0' '37 1 0' '1 65536 0' '65536 1 0' \
        '16384 16384 1 GiB' '65536 65536 1 GiB' '65537 1 2 65537' \
        '0 9 2 0' '9 -1 2 -1'; do
        # shellcheck disable=SC2086 # words
        check "C5 $size" is_right_size $size
    done
    for size in '1 1' '1 37' '37 1' '1 65536'; do
        # shellcheck disable=SC2086 # words
        check "C5 $size opencl" is_right_device_size $size
    done
}

stress_geometry() {
    rows geometry
    rows geometry opencl
}

stress_light() {
    rows light
    rows light opencl
}

# Presses more random keys than `make test`, different ones each time.
stress_keys() {
    for seed in 101 102 103; do
        check "keys, seed $seed" env TERM_KEYS=10000 TERM_SEED=$seed \
            "$build/unit/terminal/test_tty"
    done
}

# Lets one call after another fail.
stress_faults() {
    count_rows faults env BUILD="$build" tests/faults/run.sh
}

# Reaches the same samples in many ways.
stress_films() {
    mkdir "$work/films"
    # shellcheck disable=SC2086,SC2046 # words
    count_rows films tests/stress/films.sh "$(realpath "$build")/glim" "$work/films" \
        $(printf "$PWD/scenes/%s.obj " $scenes)
}

# Runs the recipes of docs/cluster.md.
stress_schedulers() {
    mkdir "$work/schedulers"
    count_rows schedulers tests/stress/schedulers.sh "$(realpath "$build")/glim" \
        "$work/schedulers" scenes/cornell.obj
}

stress_error() {
    rows error
}

stress_filter() {
    rows filter
}

stress_gltf() {
    rows gltf
}

stress_extremes() {
    rows extremes
}

for name in samples geometry light films schedulers error filter gltf blender extremes sizes keys rays \
    faults oclgrind valgrind; do
    if wanted "$name"; then
        "stress_$name"
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
