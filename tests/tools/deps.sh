#!/bin/bash
# SPDX-License-Identifier: MIT
# deps.sh - installs missing packages from Debian
#
# usage: deps.sh [-v] build|test|mpi|fuzz|lint...
# Looks for the headers and the programs themselves, so that a library from
# elsewhere counts. -v also lists what was found. When nothing is missing, a
# stamp in build/ makes the next call fast; `make clean` removes it.
set -u
cd "$(dirname "$0")/../.." || exit 1

verbose=0
if [ "${1-}" = -v ]; then
    verbose=1
    shift
fi
compiler=${CC:-cc}
case ${compiler##*/} in
clang*) compiler_package=clang ;;
*) compiler_package=gcc ;;
esac

missing=
found=

note() # package, is it there (0 yes)
{
    case " $missing $found " in
    *" $1 "*) return ;;
    esac
    if [ "$2" = 0 ]; then
        found="$found $1"
    else
        missing="$missing $1"
    fi
}

need_program() # program, package
{
    command -v "$1" >/dev/null 2>&1
    note "$2" $?
}

need_header() # header, package
{
    if command -v "${compiler%% *}" >/dev/null 2>&1; then
        printf '#include <stdarg.h>\n#include <stddef.h>\n%s\n#include <%s>\n' \
            '#include <stdint.h>
#include <setjmp.h>' "$1" |
            $compiler -E -x c - >/dev/null 2>&1
        note "$2" $?
    else # without a compiler
        test -e "/usr/include/$1"
        note "$2" $?
    fi
}

need_cxx_header() # header, package
{
    cxx=$(echo "$compiler" | sed 's/gcc/g++/; s/clang/clang++/; s/^cc$/c++/')
    # clang++ has the C++ library of g++
    echo '#include <memory>' | $cxx -E -x c++ - >/dev/null 2>&1
    note g++ $?
    test -e "/usr/include/$1" ||
        echo "#include <$1>" | $cxx -std=c++17 -E -x c++ - >/dev/null 2>&1
    note "$2" $?
}

need_library() # its file, package
{
    case $($compiler -print-file-name="$1" 2>/dev/null) in
    */*) note "$2" 0 ;;
    *) note "$2" 1 ;;
    esac
}

need_driver() # its file for the OpenCL loader, package
{
    test -e "${OCL_ICD_VENDORS:-/etc/OpenCL/vendors}/$1"
    note "$2" $?
}

look()
{
    missing=
    found=
    for part; do
        case $part in
        build)
            need_program "${compiler%% *}" "$compiler_package"
            if ! command -v "${compiler%% *}" >/dev/null 2>&1 &&
                [ ! -e /usr/include/stdio.h ]; then
                note libc6-dev 1
            else
                need_header stdio.h libc6-dev
            fi
            need_header stb/stb_image.h libstb-dev
            need_header curses.h libncurses-dev
            need_header zlib.h zlib1g-dev
            need_header CL/cl.h opencl-c-headers
            need_header jansson.h libjansson-dev
            need_header meshoptimizer.h libmeshoptimizer-dev
            need_header webp/decode.h libwebp-dev
            need_header OpenEXR/openexr.h libopenexr-dev
            need_header assimp/cimport.h libassimp-dev
            need_cxx_header draco/compression/decode.h libdraco-dev
            ;;
        test)
            need_header cmocka.h libcmocka-dev
            need_library libOpenCL.so.1 ocl-icd-libopencl1
            need_library libblosc.so.1 libblosc1
            need_driver pocl.icd pocl-opencl-icd
            need_program tmux tmux
            need_program pgrep procps
            need_program readelf binutils
            need_program mandoc mandoc
            ;;
        mpi)
            need_program mpicc libopenmpi-dev
            need_program mpirun openmpi-bin
            ;;
        fuzz)
            need_program "${compiler%% *}" "$compiler_package"
            # Debian packages libFuzzer with the other runtimes of its clang
            need_library "libclang_rt.fuzzer-$(uname -m).a" \
                "libclang-rt-$($compiler -dumpversion | cut -d. -f1)-dev"
            ;;
        lint)
            need_program clang-format clang-format
            need_program clang-tidy clang-tidy
            need_program cppcheck cppcheck
            need_program mandoc mandoc
            ;;
        results) need_program gnuplot gnuplot-nox ;;
        *)
            echo "deps.sh: what is '$part'? build, test, mpi, fuzz, lint or" \
                results >&2
            exit 2
            ;;
        esac
    done
}

give_up()
{
    echo "deps: $1" >&2
    echo "deps: please install these yourself (Debian's names):$missing" >&2
    exit 1
}

install_missing()
{
    command -v apt-get >/dev/null 2>&1 || give_up "there is no apt-get here"
    as_root=
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null 2>&1 ||
            give_up "not root, and there is no sudo"
        as_root=sudo
    fi
    echo "deps: installing$missing"
    # The first try succeeds if the package lists exist and are recent.
    # shellcheck disable=SC2086 # words are meant to be split
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
        --no-install-recommends $missing >"$log" 2>&1 </dev/null && return
    echo "deps: the package lists are missing or old: apt-get update"
    $as_root apt-get update -qq >"$log" 2>&1 </dev/null ||
        { tail -5 "$log" >&2; give_up "apt-get update failed"; }
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
        --no-install-recommends $missing >"$log" 2>&1 </dev/null ||
        { tail -5 "$log" >&2; give_up "apt-get install failed"; }
}

mkdir -p build || exit 1
log=build/deps.log
stamp=build/deps-$(echo "$compiler $*" | tr -c 'a-z0-9\n' -)
if [ $verbose = 0 ] && [ -e "$stamp" ] && [ "$stamp" -nt "$0" ]; then
    exit 0
fi

look "$@"
[ $verbose = 1 ] && echo "deps: found:${found:- nothing}"
if [ -n "$missing" ]; then
    echo "deps: missing:$missing"
    install_missing
    look "$@"
    [ -z "$missing" ] || give_up "still missing after the installation"
    echo "deps: done"
elif [ $verbose = 1 ]; then
    echo "deps: nothing is missing"
fi
: >"$stamp"
