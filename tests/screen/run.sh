#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh - the screen: the program in tmux, keys in, text out
#
# Each case starts the program in a tmux server of its own at 100x30 and looks
# at what stands on the screen. BUILD names the folder with the program.
set -u
cd "$(dirname "$0")/../.." || exit 1
root=$PWD
build=${BUILD:-build/release}
case $build in
/*) ;;
*) build=$root/$build ;;
esac
passed=0
failed=0

if ! command -v tmux >/dev/null; then
    echo 'skip all (no tmux)'
    echo 'screen: 0 passed, 0 failed'
    exit 0
fi
work=$(mktemp -d) || exit 1
starts=0
socket=$work/tmux0
trap 'tm kill-server 2>/dev/null; rm -rf "$work"' EXIT

tm()
{
    tmux -S "$socket" -f /dev/null "$@"
}

# A shell in a terminal, and in it the program.
start()
{
    tm kill-server 2>/dev/null
    # an old server may still be going: a socket of its own for each
    starts=$((starts + 1))
    socket=$work/tmux$starts
    tm new-session -d -x 100 -y 30 "cd '$work' && PS1='shell> ' sh"
    tm send-keys "'$build/glim' $*; echo status \$?" Enter
}

screen()
{
    tm capture-pane -p 2>/dev/null
}

# Waits up to 20 s for the text.
sees()
{
    for _ in $(seq 200); do
        if screen | grep -q -e "$1"; then
            return 0
        fi
        sleep 0.1
    done
    echo "    '$1' never came; the screen at last:"
    screen | sed 's/^/    |/'
    return 1
}

flag()
{
    tm display-message -p "#{$1}"
}

box=$root/scenes/cornell.obj

# The picture is half blocks in colour; q gives the terminal back.
case_opens_and_quits()
{
    start "$box" && sees LIVE && sees ▀ || return 1
    tm capture-pane -e -p | grep -q '38;2;' || return 1
    [ "$(flag alternate_on)" = 1 ] || return 1
    tm send-keys q
    sees 'status 0' && [ "$(flag alternate_on)" = 0 ] &&
        [ "$(flag cursor_flag)" = 1 ] && [ "$(flag mouse_any_flag)" = 0 ]
}

case_help_opens_and_closes()
{
    start "$box" && sees LIVE && tm send-keys '?' || return 1
    sees 'forward' || return 1
    tm send-keys x
    sleep 0.5
    ! screen | grep -q 'forward'
}

# p writes numbered names and says so.
case_saves_numbered()
{
    rm -f "$work"/*.png
    start -w 64 -h 64 "$box" && sees LIVE && tm send-keys p || return 1
    sees 'cornell.png' && tm send-keys p && sees 'cornell-2.png' || return 1
    [ -s "$work/cornell.png" ] && [ -s "$work/cornell-2.png" ]
}

# Normal mode ends at its samples.
case_normal_mode_ends()
{
    start -w 64 -h 64 -s 4 "$box" && sees LIVE && tm send-keys Space ||
        return 1
    sees NORMAL && tm send-keys Enter && sees '4/4\|100 *%'
}

# Another size lays everything out anew.
case_resizes()
{
    start "$box" && sees LIVE && tm resize-window -x 60 -y 20 || return 1
    sleep 0.5
    sees LIVE && tm resize-window -x 140 -y 45 && sleep 0.5 && sees LIVE
}

# Signals give the terminal back and show in the status.
case_signals_restore()
{
    for pair in TERM:143 HUP:129 INT:130; do
        start "$box" && sees LIVE || return 1
        pid=$(tm display-message -p '#{pane_pid}')
        pkill -"${pair%:*}" -P "$pid" glim || return 1
        sees "status ${pair#*:}" && [ "$(flag alternate_on)" = 0 ] || return 1
    done
}

# An error is printed on the ordinary screen.
case_errors_do_not_open_a_screen()
{
    start nosuch.obj && sees 'nosuch.obj' && sees 'status 1' &&
        [ "$(flag alternate_on)" = 0 ]
}

for name in opens_and_quits help_opens_and_closes saves_numbered \
    normal_mode_ends resizes signals_restore errors_do_not_open_a_screen; do
    if "case_$name"; then
        echo "ok $name"
        passed=$((passed + 1))
    else
        echo "FAIL $name"
        failed=$((failed + 1))
    fi
done
echo "screen: $passed passed, $failed failed"
[ "$failed" = 0 ]
