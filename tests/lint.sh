#!/bin/sh
# SPDX-License-Identifier: MIT
# lint.sh - checks layers, layout, cppcheck, clang-tidy, kernels as OpenCL and
# the manual (`make lint`)
#
# Reads the names of the files whose layout is checked. SOURCES are the files for
# clang-tidy, FLAGS their compiler's flags, BUILD the folder for generated files.
set -eu
cd "$(dirname "$0")/.."

tests/layers.sh
xargs clang-format --dry-run -Werror

# The tables without their numbers, which cppcheck would follow for two seconds
# in each file and each configuration. Suppressed are false reports: errors that
# are set before they are read, and stacks.
mkdir -p "$BUILD/lint/kernels"
sed '/^ *-*[0-9]/d' kernels/energy_tables.h >"$BUILD/lint/kernels/energy_tables.h"
cppcheck --quiet --std=c11 --error-exitcode=1 --inline-suppr "-j$(nproc)" \
    --enable=warning,portability --suppress=missingIncludeSystem \
    --suppress=uninitvar --suppress=ctuuninitvar \
    --suppress=duplicateAssignExpression "-I$BUILD/lint" -I. -Isrc -Iinclude src

# Without checks that report falsely: the analyzer's core does not know that
# fail() returns false, and OpenCL handles are pointers, so sizeof *array is
# right.
tidy='-*,clang-analyzer-*,-clang-analyzer-core.*'
for check in branch-clone easily-swappable-parameters \
    implicit-widening-of-multiplication-result narrowing-conversions \
    not-null-terminated-result reserved-identifier sizeof-expression \
    suspicious-memory-comparison; do
    off=${off-},-bugprone-$check
done
tidy="$tidy,-clang-analyzer-valist.Uninitialized"
tidy="$tidy,-clang-analyzer-security.insecureAPI.Deprecated*,bugprone-*$off"
export tidy
# shellcheck disable=SC2016 # the inner shell expands these
# shellcheck disable=SC2086 # words
printf '%s\n' $SOURCES | xargs -n8 "-P$(nproc)" sh -c 'clang-tidy --quiet \
    --warnings-as-errors="*" --checks="$tidy" "$@" -- $FLAGS' sh

# The kernels for a generic OpenCL device
if command -v clang >/dev/null; then
    clang -target spir64 -x cl -cl-std=CL1.2 -Xclang -finclude-default-header \
        -fsyntax-only -I. -Wall -Wextra -Wdouble-promotion -Werror kernels/*.cl
fi
mandoc -T lint -W warning man/glim.1 man/libglim.3
