#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh - the screen: scripts that press keys in tmux and look at the cells
#
# Runs cases/NAME.sh in an empty folder, each with a tmux server of its own. A
# script fails where a command of it fails; status 77 skips it, its last line
# says why. BUILD names the folder with the program (build/release); arguments
# name the cases (all).
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
build=${BUILD:-build/release}
case $build in
/*) ;;
*) build=$root/$build ;;
esac
PATH=$build:$PATH
SCREEN=$root/tests/screen
LC_ALL=C.UTF-8
POCL_CACHE_DIR=$build/pocl
export PATH SCREEN LC_ALL POCL_CACHE_DIR root
unset NO_COLOR GLIM_COLOR COLORTERM TMUX STY TERM
# the person's own taste is not tested
XDG_CONFIG_HOME=$root/tests/screen/none
export XDG_CONFIG_HOME

if [ ! -x "$build/glim" ]; then
    echo "screen: no program $build/glim, build it first"
    exit 1
fi
if [ $# = 0 ]; then
    for script in "$SCREEN"/cases/*.sh; do
        set -- "$@" "$(basename "$script" .sh)"
    done
fi
if ! command -v tmux >/dev/null; then
    for name in "$@"; do
        echo "skip $name (no tmux)"
    done
    echo "screen: 0 passed, 0 failed"
    exit 0
fi
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

for name in "$@"; do
    out=$work/$name.out
    mkdir "$work/$name"
    XDG_STATE_HOME=$work/$name.state
    export XDG_STATE_HOME
    SOCKET=$work/$name.tmux
    export SOCKET
    (cd "$work/$name" && timeout --kill-after=5 180 \
        sh -eu -c '. "$SCREEN/lib.sh"; . "$SCREEN/cases/$0.sh"' "$name") \
        >"$out" 2>&1 </dev/null
    status=$?
    if [ $status != 0 ] && [ $status != 77 ]; then
        echo "FAIL $name (exit $status)"
        cat "$out"
        tmux -S "$SOCKET" capture-pane -p 2>&1 | sed 's/^/    | /'
        failed=$((failed + 1))
    elif [ $status = 77 ]; then
        echo "skip $name ($(tail -n 1 "$out"))"
    else
        echo "ok $name"
        passed=$((passed + 1))
    fi
    tmux -S "$SOCKET" kill-server 2>/dev/null
done
echo "screen: $passed passed, $failed failed"
[ $failed = 0 ] && [ $passed -gt 0 ]
