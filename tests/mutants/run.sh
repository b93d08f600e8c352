#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - breaks one factor after another in a copy of the sources; a unit test
# must notice each (`make mutants`)
#
# tests/mutants/list has the mutants. FILTER=PART selects some by their names,
# files or tests; CC is the compiler. The last line is "mutants: N passed, N
# failed"; the log of a mutant that no test noticed is printed.
set -u
cd "$(dirname "$0")/../.." || exit 1
copy=$PWD/build/mutants
# the copy stands elsewhere, where tests would skip what they do not find
export THOROUGH=1
export GLIM_SHARED=${GLIM_SHARED:-$PWD/../shared}
passed=0
failed=0

trim()
{
    sed 's/^ *//; s/ *$//' <<<"$1"
}

# Applies the change, and restores the file afterwards.
try() # name, file, sed expression, test
{
    local target=build/release/few/unit/$4 status

    sed -i.orig "$2" "$copy/$3" || return 1
    if cmp -s "$copy/$3" "$copy/$3.orig"; then
        echo "FAIL $1: $3 has nothing to change"
        status=1
    elif ! make -s -C "$copy" BUILDS=few CC="${CC:-cc}" "$target" >"$copy/log" 2>&1; then
        echo "FAIL $1: does not compile"
        tail -n 5 "$copy/log"
        status=1
    elif (cd "$copy" && timeout 300 "$target") >"$copy/log" 2>&1; then
        echo "FAIL $1: $4 is green"
        status=1
    else
        echo "ok $1: $(sed -n 's/.*\[  FAILED  \] \([a-z_0-9]*\)$/\1/p' \
            "$copy/log" | sort -u | tr '\n' ' ')"
        status=0
    fi
    mv "$copy/$3.orig" "$copy/$3"
    touch "$copy/$3"
    echo "$3" >>"$copy/build/mutated"
    return $status
}

mkdir -p "$copy"
# without files that are gone; times are kept, so that only changes are compiled
find "$copy" -mindepth 1 -maxdepth 1 ! -name build -exec rm -r {} +
git ls-files -z | tar --null -T - -c | tar -x -C "$copy"
# files that were broken in the last run, whose objects are newer
mkdir -p "$copy/build"
if [ -f "$copy/build/mutated" ]; then
    (cd "$copy" && xargs -r touch -c <build/mutated && rm build/mutated)
fi
while IFS='|' read -r name file change test; do
    case $name in
    '' | '#'*) continue ;;
    esac
    [[ $name$file$test == *"${FILTER-}"* ]] || continue
    if try "$(trim "$name")" "$(trim "$change")" "$(trim "$file")" \
        "$(trim "$test")"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
    fi
done <tests/mutants/list
echo "mutants: $passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
