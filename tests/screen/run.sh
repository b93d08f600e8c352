#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - screen tests: scripts that press keys in tmux and inspect the cells
#
# Runs cases/NAME.sh in an empty folder, each with a tmux server of its own. A
# script fails when one of its commands fails; status 77 skips it, and its last
# line is the reason. BUILD is the folder of the program (build/release). JOBS
# is the number of cases that run at once, since they mostly wait. Arguments
# name the cases (default: all).
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
SCREEN=$root/tests/screen
LC_ALL=C.UTF-8
POCL_CACHE_DIR=$build/pocl
export PATH SCREEN LC_ALL POCL_CACHE_DIR root
unset NO_COLOR GLIM_COLOR COLORTERM TMUX STY TERM

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
# the user's configuration is not tested; by day one thread renders, since cases
# wait for the program, which renders as long as they do
mkdir -p "$work/xdg/glim"
[ -n "${THOROUGH-}" ] || echo 'option t 1' >"$work/xdg/glim/config"
XDG_CONFIG_HOME=$work/xdg
export XDG_CONFIG_HOME

# Stops the programs in tmux when the run is interrupted.
end_all()
{
    for socket in "$work"/*.tmux; do
        tmux -S "$socket" kill-server 2>/dev/null
    done
    rm -rf "$work"
}
trap end_all EXIT
trap 'exit 143' TERM
mkdir "$work/failed" "$work/passed"

# Runs a case and prints its result in one piece, so that parallel cases do not
# mix.
run_case()
{
    local name=$1 out=$work/$1.out status begin=$SECONDS

    mkdir "$work/$name"
    XDG_STATE_HOME=$work/$name.state
    SOCKET=$work/$name.tmux
    export XDG_STATE_HOME SOCKET
    (cd "$work/$name" && timeout --kill-after=5 300 \
        sh -eu -c '. "$SCREEN/lib.sh"; . "$SCREEN/cases/$0.sh"' "$name") \
        >"$out" 2>&1 </dev/null
    status=$?
    if [ $status = 77 ]; then
        echo "skip $name ($(tail -n 1 "$out"))"
    elif [ $status = 0 ]; then
        echo "ok $name $((SECONDS - begin)) s"
        : >"$work/passed/$name"
    else
        printf '%s\n%s\n%s\n' "FAIL $name (exit $status)" "$(cat "$out")" \
            "$(tmux -S "$SOCKET" capture-pane -p 2>&1 | sed 's/^/    | /')"
        : >"$work/failed/$name"
    fi
    tmux -S "$SOCKET" kill-server 2>/dev/null
}

JOBS=${JOBS:-$(($(nproc) + 1))}
for name in "$@"; do
    in_pool run_case "$name"
done
wait
passed=$(find "$work/passed" -type f | wc -l)
failed=$(find "$work/failed" -type f | wc -l)
echo "screen: $passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
