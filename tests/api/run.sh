#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - libglim as others use it: installed in a folder of its own, and
# compiled against with what its .pc file says
#
# BUILD names the folder with the programs. Ends with "api: N passed, N failed".
set -u
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${BUILD:-build/release}")
compiler=${CC:-cc}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unset POCL_CACHE_DIR # no device is remembered
passed=0
failed=0

check() # what, command
{
    local what=$1

    shift
    if "$@" >"$folder/log" 2>&1; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $what"
        cat "$folder/log"
    fi
}

# The value of a key of the .pc file, as if it were installed at the root.
of_pc() # key
{
    sed -n "s/^$1: *//p" "$pc" |
        sed "s|\${libdir}|$lib|g; s|\${includedir}|$include|g"
}

check install make -s install "DESTDIR=$folder/root" "CC=$compiler" \
    "SAN=${SAN-}" "BUILDS=${BUILDS-all}"
pc=$(find "$folder/root" -name glim.pc)
include=$(dirname "$(dirname "$(find "$folder/root" -name glim.h)")")
lib=$(dirname "$(find "$folder/root" -name libglim.a)")

# The functions of the header are all that a library shows.
sed -n 's/^GLIM_API .*[ *]\(glim_[a-z_]*\)(.*/\1/p' "$include/glim/glim.h" |
    sort >"$folder/declared"
nm -D --defined-only "$lib/libglim.so" | awk '{ print $3 }' |
    sort >"$folder/shared"
nm -g --defined-only "$lib/libglim.a" | awk 'NF == 3 { print $3 }' |
    sort >"$folder/static"
check 'symbols of libglim.so' diff "$folder/declared" "$folder/shared"
check 'symbols of libglim.a' diff "$folder/declared" "$folder/static"
soname=$(readelf -d "$lib/libglim.so" |
    sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')
check SONAME test "$soname" = libglim.so.0 -a -e "$lib/$soname"
check version test "glim $(of_pc Version)" = "$("$build/glim" --version |
    head -1)"
for name in $(cat "$folder/declared"); do
    check "manual: $name" grep -q "^\.Fn $name " man/libglim.3
done
if command -v pkg-config >/dev/null; then
    check pkg-config env "PKG_CONFIG_PATH=${pc%/*}" \
        pkg-config --exists --print-errors glim
fi

compile() # source, program, flags of the linker
{
    # shellcheck disable=SC2046,SC2086 # words
    $compiler -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wpedantic \
        -Werror ${SAN:+-fsanitize=$SAN} $(of_pc Cflags) -o "$2" "$1" $3 -pthread
}

check 'example, shared' compile tests/api/example.c "$folder/shared_example" \
    "$(of_pc Libs) -Wl,-rpath,$lib"
check 'example, static' compile tests/api/example.c "$folder/static_example" \
    "$lib/libglim.a $(of_pc Libs.private)"
check checks compile tests/api/checks.c "$folder/checks" \
    "$(of_pc Libs) -Wl,-rpath,$lib"
if command -v c++ >/dev/null; then
    echo '#include <glim/glim.h>' >"$folder/header.cc"
    # shellcheck disable=SC2046 # words
    check 'header as C++' c++ -Wall -Wextra -Werror -fsyntax-only \
        $(of_pc Cflags) "$folder/header.cc"
fi

# The pictures are those of the program.
"$build/glim" -b -w 96 -s 8 --seed 7 -o "$folder/glim.png" scenes/cornell.obj \
    2>"$folder/log" || cat "$folder/log"
for kind in shared static; do
    check "run, $kind" "$folder/${kind}_example" scenes/cornell.obj \
        "$folder/$kind.png"
    check "picture, $kind" cmp "$folder/$kind.png" "$folder/glim.png"
done
"$folder/shared_example" scenes/cornell.obj "$folder/stop.png" 0 >"$folder/out"
check stopped grep -q '^stopped$' "$folder/out"
"$folder/shared_example" scenes/none.obj x.png >"$folder/out" 2>"$folder/err"
check 'its error' test "$? $(cat "$folder/err")" = \
    "1 example: scenes/none.obj: no such file or folder"

# Films of the program are joined by the library, and the other way round.
small='-b -w 32 -h 24'
for i in 1 2 3; do
    # shellcheck disable=SC2086 # words
    "$build/glim" $small -s 8 --share $i/3 --film "$folder/$i.film" \
        -o "$folder/share.png" scenes/cornell.obj 2>"$folder/log"
done
scene=$PWD/scenes/cornell.obj
(cd "$folder" && ./checks "$scene" 1.film 3.film 2.film) >"$folder/out" \
    2>"$folder/err"
# shellcheck disable=SC2086 # words
"$build/glim" $small -s 8 --resume "$folder/saved.film" -o "$folder/saved.png" \
    scenes/cornell.obj 2>"$folder/log" || cat "$folder/log"
# shellcheck disable=SC2086 # words
"$build/glim" $small -s 8 -o "$folder/whole.png" scenes/cornell.obj \
    2>"$folder/log"
check 'films of the library' cmp "$folder/saved.png" "$folder/whole.png"
check 'films of the program' cmp "$folder/joined.png" "$folder/whole.png"
check 'nothing on standard error' test ! -s "$folder/err"
grep -v '^api: ' "$folder/out"
counts=$(sed -n 's/^api: \([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' \
    "$folder/out")
check 'all checks ran' test -n "$counts"
passed=$((passed + ${counts% *}))
failed=$((failed + ${counts#* }))

check uninstall make -s uninstall "DESTDIR=$folder/root"
check 'nothing is left' test -z "$(find "$folder/root" -type f -o -type l)"
echo "api: $passed passed, $failed failed"
[ "$failed" = 0 ]
