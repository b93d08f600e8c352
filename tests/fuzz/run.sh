#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - runs the fuzz targets on the corpus
#
# BUILD is the folder of the programs (build/release), SAN names their
# sanitizers, arguments name the targets (default: all). Each input has limits
# on processor time and memory and a stack of 1 MiB.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build/release}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work
export LSAN_OPTIONS=suppressions=$PWD/tests/tools/lsan.supp:print_suppressions=0
seconds=5
mebibytes=256
if [ -n "${SAN-}" ]; then
    seconds=60
    mebibytes=2048
else
    ulimit -s 1024
fi
ulimit -c 0
passed=0
failed=0

# Generates inputs that are too large for the repository. Each of them once took
# minutes, or all of the memory.
generate()
{
    mkdir -p "$work/"{mtl,obj,ply,scene}
    # a hub of 100,000 faces, each a colour of its own and each twice
    awk 'BEGIN {
        n = 100000
        print "ply\nformat ascii 1.0\nelement vertex " n + 1
        print "property float x\nproperty float y\nproperty float z"
        print "element face " 2 * n "\nproperty list uchar int vertex_index"
        print "property uchar red\nproperty ushort green"
        print "property uchar blue\nend_header\n0 0 1"
        for (i = 0; i < n; i++)
            print cos(i), sin(i), i % 7
        for (i = 0; i < 2 * n; i++)
            print 3, 0, i % n + 1, (i + 1) % n + 1, 1, i, 2
    }' >"$work/ply/hub"
    # a star polygon, whose edges cross nearly all others
    awk 'BEGIN {
        n = 8000
        for (i = 0; i < n; i++) {
            a = 6.28318530717959 * i * (n / 2 - 1) / n
            printf "v %.9g %.9g %.9g\n", cos(a), sin(a), sin(i) / 1000
            face = face " " i + 1
        }
        print "f" face
    }' >"$work/scene/star"
    # names with as many slashes as a line can hold
    awk 'BEGIN {
        while (i++ < 60000)
            name = name "/"
        print "mtllib x" name ".../b"
    }' >"$work/obj/slashes"
    awk 'BEGIN {
        while (i++ < 30000)
            name = name "a/"
        print "newmtl m\nmap_Kd " name "b.png"
    }' >"$work/mtl/folders"
}

replay() # NAME FILE...
{
    local name=$1 file status

    shift
    for file; do
        # the subshell writes the signal into the log
        (timeout --kill-after=5 120 "$build/fuzz/fuzz_$name" $seconds \
            $mebibytes "$file"; exit $?) >"$work/log" 2>&1 </dev/null
        status=$?
        if [ $status = 0 ]; then
            passed=$((passed + 1))
        else
            failed=$((failed + 1))
            echo "FAIL $name $file (exit $status)"
            head -n 40 "$work/log"
        fi
    done
}

generate
if [ $# = 0 ]; then
    for target in tests/fuzz/fuzz_*.c; do
        name=$(basename "$target" .c)
        set -- "$@" "${name#fuzz_}"
    done
fi
for name; do
    files=("tests/fuzz/corpus/$name"/*)
    [ -d "$work/$name" ] && files+=("$work/$name"/*)
    replay "$name" "${files[@]}"
done
echo "fuzz: $passed passed, $failed failed"
[ $failed = 0 ] && [ $passed -gt 0 ]
