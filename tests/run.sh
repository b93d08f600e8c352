#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - runs every test and ends with "N passed, N failed"
#
# BUILD is the folder of the programs (build/release/few). FILTER=WORD runs only the
# parts whose names contain it: layers, tour, links, results, man, scenes,
# hardening, a test_x, fuzz, api, cli, screen.
set -u
cd "$(dirname "$0")/.." || exit 1
. tests/pool.sh
export BUILD=${BUILD:-build/release/few}
# PoCL's cache, apart from the user's
POCL_CACHE_DIR=$(realpath "$BUILD")/pocl
export POCL_CACHE_DIR
# PoCL's compiler replaces the signal stacks of threads, which the sanitizer
# would free at their end
export ASAN_OPTIONS=use_sigaltstack=0:${ASAN_OPTIONS-}
export LSAN_OPTIONS=suppressions=$PWD/tests/tools/lsan.supp:print_suppressions=0
export SAN=${SAN-}
# the slowest tests take all of their trials
[ "${BUILDS-}" = all ] && export THOROUGH=1
FILTER=${FILTER-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

wanted()
{
    [[ $1 == *"$FILTER"* ]]
}

# Runs a part of the tests: a function with a name and a command, which writes the
# counts of what passed and failed. Shows them with the part's seconds, and the
# log if something failed, in one piece.
part() # function, name, command
{
    local name=${2##*/} begin=${EPOCHREALTIME/,/.} counts time

    wanted "$2" || return
    log=$work/$name.log
    counts=$("$@" 2>&1) # the functions write to the log what they run
    time=$(awk "BEGIN { printf \"%.1f s\", ${EPOCHREALTIME/,/.} - $begin }")
    echo "$time $name" >>"$work/times"
    echo "$counts" >>"$work/counts"
    if [ "${counts#* }" -gt 0 ]; then
        printf '%s\n%-26s %7s %4d passed, %d failed\n' \
            "$(tail -c 20000 "$log")" "$name" "$time" "${counts% *}" "${counts#* }"
    else
        printf '%-26s %7s %4d passed%s\n' "$name" "$time" "${counts% *}" \
            "$(grep -ai skip "$log" | grep -av '^\[  SKIPPED \] [0-9]* test' |
                grep -av 'SKIPPED TEST(S)$' |
                awk '!seen[$0]++ { printf "\n    %s", $0 }')"
    fi
}

# Runs a cmocka program. It prints the number of tests before it runs them, so
# tests that a crash has swallowed are noticed.
run_unit()
{
    local started ok skipped status bad

    timeout --kill-after=5 600 "$2" >"$log" 2>&1 </dev/null
    status=$?
    started=$(sed -n 's/^\[=*\].* Running \([0-9]*\) test.*/\1/p' "$log" |
        awk '{ n += $1 } END { print n + 0 }')
    ok=$(grep -ac '^\[       OK \]' "$log")
    skipped=$(grep -a '^\[  SKIPPED \] [^ ]*$' "$log" | sort -u | wc -l)
    bad=$((started - ok - skipped))
    if [ $bad -le 0 ] && { [ $status != 0 ] || [ "$started" = 0 ]; }; then
        echo "$2: exit status $status after $started tests" >>"$log"
        bad=1
    fi
    echo "$ok $bad"
}

# Runs a script that ends with "NAME: N passed, N failed".
run_script()
{
    local name=$1 counts status

    shift
    timeout --kill-after=5 600 "$@" >"$log" 2>&1 </dev/null
    status=$?
    counts=$(sed -n "s/^$name: \([0-9]*\) passed, \([0-9]*\) failed.*/\1 \2/p" \
        "$log" | tail -1)
    if [ -z "$counts" ] || { [ $status != 0 ] && [ "${counts#* }" = 0 ]; }; then
        echo "$name: exit status $status without a count of what failed" >>"$log"
        counts="${counts% *}"
        counts="${counts:-0} 1"
    fi
    echo "$counts"
}

# Runs cases of a folder: its script takes their names.
run_cases() # name of the part, folder, cases
{
    local folder=$2

    shift 2
    run_script "$folder" "tests/$folder/run.sh" "$@"
}

# Runs a command that must end with status 0.
run_check()
{
    shift
    if "$@" >"$log" 2>&1 </dev/null; then
        echo 1 0
    else
        echo 0 1
    fi
}

# Compares the scenes in the repository with the output of their generator.
scenes_are_generated()
{
    local folder status=0 file

    folder=$(mktemp -d)
    "$BUILD/scenes/generate" "$folder" || status=1
    for file in "$folder"/*; do
        cmp "$file" "scenes/${file##*/}" || status=1
    done
    rm -rf "$folder"
    return $status
}

# Checks that the program has the compiler's and linker's protection against
# writes out of bounds.
program_is_hardened()
{
    local status=0

    has() # pattern, readelf option
    {
        readelf -W "$2" "$BUILD/glim" | grep -Eq "$1" && return
        echo "$BUILD/glim: readelf $2 does not show '$1'"
        status=1
    }
    has 'Type: *DYN' --file-header
    has GNU_RELRO --program-headers
    has 'GNU_STACK.* RW ' --program-headers
    has 'BIND_NOW|Flags:.* NOW' --dynamic
    has __stack_chk_fail --dyn-syms
    # sanitizers have their own checks, and these need the optimiser
    if [ -z "$SAN" ] && grep -Eq -e ' -O[1-3s]' "${BUILD%/few}/flags"; then
        has __snprintf_chk --dyn-syms
    fi
    return $status
}

# Tests whose limits are of time, and which therefore run after all others; all
# but the commands mostly wait
timed=' base/test_stop base/test_child '
timed_cases=' stop opencl '

# What mostly waits runs beside the others.
cases=()
for script in tests/cli/cases/*.sh; do
    name=$(basename "$script" .sh)
    [[ $timed_cases == *" $name "* ]] || cases+=("$name")
done
part run_script screen tests/screen/run.sh &
part run_cases cli cli "${cases[@]}" &
part run_script fuzz tests/fuzz/run.sh &
JOBS=$(($(nproc) + 3)) # with these three

in_pool part run_check layers tests/layers.sh
in_pool part run_check tour tests/tour.sh
in_pool part run_check mutants tests/mutants/check.sh
in_pool part run_check links tests/links.sh
in_pool part run_check results tests/bench/results/draw.sh --check
in_pool part run_check man-lint mandoc -T lint -W warning man/glim.1 man/libglim.3
in_pool part run_check scenes scenes_are_generated
in_pool part run_check hardening program_is_hardened
in_pool part run_script api tests/api/run.sh
begun=' '
# those of a device compile for a minute, and begin first
for program in tests/unit/*/test_*_cl.c tests/unit/*/test_*.c; do
    name=${program#tests/unit/}
    name=${name%.c}
    [[ $timed$begun == *" $name "* ]] || in_pool part run_unit "$name" "$BUILD/unit/$name"
    begun+="$name "
done
wait
# shellcheck disable=SC2086 # words
part run_cases cli-timed cli $timed_cases &
for name in $timed; do
    part run_unit "$name" "$BUILD/unit/$name" &
done
wait

echo "slowest: $(sort -rn "$work/times" | head -5 | paste -sd ,)"
awk '{ passed += $1; failed += $2 }
    END { print passed + 0 " passed, " failed + 0 " failed"
          exit failed > 0 || passed == 0 }' "$work/counts"
