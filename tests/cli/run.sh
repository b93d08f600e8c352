#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - command line tests: scripts with the expected output beside them
#
# Runs cases/NAME.sh in an empty folder and compares its output (standard output
# and error together) with cases/NAME.out. A script that ends with status 77 is
# skipped; its last line is the reason. BUILD is the folder of the program
# (build/release), JOBS the number of cases that run at once; arguments name the
# cases (default: all).
set -u
cd "$(dirname "$0")/../.." || exit 1
. tests/pool.sh
root=$PWD
build=${BUILD:-build/release}
case $build in
/*) ;;
*) build=$root/$build ;;
esac
PATH=$build:$PATH
CLI=$root/tests/cli
export PATH CLI root
# a failed allocation causes a message, also with sanitizers
ASAN_OPTIONS=allocator_may_return_null=1:${ASAN_OPTIONS-}
TSAN_OPTIONS=allocator_may_return_null=1:${TSAN_OPTIONS-}
LSAN_OPTIONS=suppressions=$root/tests/tools/lsan.supp:print_suppressions=0
LC_ALL=C
POCL_CACHE_DIR=$build/pocl
export ASAN_OPTIONS LSAN_OPTIONS TSAN_OPTIONS LC_ALL POCL_CACHE_DIR
unset NO_COLOR GLIM_COLOR COLORTERM
# the user's configuration is not tested
XDG_CONFIG_HOME=$root/tests/cli/none
export XDG_CONFIG_HOME

if [ ! -x "$build/glim" ]; then
    echo "cli: no program $build/glim, build it first"
    exit 1
fi
work=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
mkdir "$work/passed" "$work/failed"

run_case()
{
    local name=$1 out=$work/$1.out status

    mkdir "$work/$name"
    export XDG_STATE_HOME=$work/$name.state
    (cd "$work/$name" && timeout --kill-after=5 120 \
        sh -u -c '. "$CLI/lib.sh"; . "$CLI/cases/$0.sh"' "$name") \
        >"$out" 2>&1 </dev/null
    status=$?
    if [ $status = 77 ]; then
        echo "skip $name ($(tail -n 1 "$out"))"
    elif [ $status = 0 ] && cmp -s "$out" "$CLI/cases/$name.out"; then
        echo "ok $name"
        : >"$work/passed/$name"
    else
        printf '%s\n%s\n' "FAIL $name (exit $status)" \
            "$(diff -u "$CLI/cases/$name.out" "$out" | tail -n +3)"
        : >"$work/failed/$name"
    fi
}

if [ $# = 0 ]; then
    for script in "$CLI"/cases/*.sh; do
        set -- "$@" "$(basename "$script" .sh)"
    done
fi
for name in "$@"; do
    in_pool run_case "$name"
done
wait
passed=$(find "$work/passed" -type f | wc -l)
failed=$(find "$work/failed" -type f | wc -l)
echo "cli: $passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
