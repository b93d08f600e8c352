# SPDX-License-Identifier: MIT
# lib.sh - functions for the cases
#
# A case runs in an empty folder. `start` opens a tmux window in which the
# program runs; the other functions press keys and inspect the screen. A wait
# fails after some minutes. No case waits for a fixed time: after `wait_until
# rests` nothing changes without input.

mux()
{
    tmux -u -S "$SOCKET" -f /dev/null "$@"
}

# Prints the reason and ends the case.
die()
{
    echo "$*"
    exit 1
}

# Opens a window of $size cells with a shell that runs the given line. The
# terminal's settings before and after it are kept in files.
size=60x21
start_line()
{
    cat >line.sh <<END
stty -g >before
echo "shell was here"
$1
status=\$?
stty -g >after
echo "exit \$status"
exec sleep 1000
END
    mux new-session -d -x "${size%x*}" -y "${size#*x}" \
        "exec bash --norc line.sh" \; set-option -g status off \; \
        set-option -g window-size manual \; \
        set-option -g default-terminal tmux-256color
}

# Runs glim with these arguments.
start()
{
    start_line "TERM=tmux-256color glim $*"
}

# Closes the window, so that another can be opened.
fresh()
{
    mux kill-server
    while mux has-session 2>/dev/null; do
        sleep 0.05
    done
    rm -f "$SOCKET"
}

keys()
{
    mux send-keys "$@"
}

# Sends bytes unchanged.
raw_keys()
{
    mux send-keys -l -- "$1"
}

screen()
{
    mux capture-pane -p
}

# Prints the screen with colour sequences and trailing blanks.
screen_colors()
{
    mux capture-pane -p -e -N
}

# Counts the rows that contain this colour. Sequences occur only where colours
# change, so the colour is tracked from cell to cell.
rows_with()
{
    screen_colors | awk -v want="$1" '{
        has = color == want && $0 != "" && substr($0, 1, 1) != "\033"
        for (line = $0; match(line, /\033\[[0-9;]*m/);) {
            text = substr(line, 1, RSTART - 1)
            if (text != "" && color == want)
                has = 1
            code = substr(line, RSTART + 2, RLENGTH - 3)
            if (code ~ /48;|49|^0?$|^4[0-9]/)
                color = code
            line = substr(line, RSTART + RLENGTH)
        }
        if (line != "" && color == want)
            has = 1
        n += has
    } END { print n + 0 }'
}

# Waits until the command succeeds: most do at once, and a long wait looks seldom.
# The limit, minutes, allows for a device's compiler on a machine that has other
# work.
wait_until()
{
    tries=0
    until "$@"; do
        tries=$((tries + 1))
        [ $tries -lt 800 ] || die "waited for: $*"
        [ $tries -lt 20 ] && sleep 0.03 || sleep 0.2
    done
}

# True if a line of the screen matches.
has_line()
{
    screen | grep -q -e "$1"
}

lacks_line()
{
    ! has_line "$1"
}

has_rows()
{
    [ "$(rows_with "$2")" = "$1" ]
}

wait_for()
{
    wait_until has_line "$1"
}

wait_until_gone()
{
    wait_until lacks_line "$1"
}

# Waits until this number of rows contain the colour.
wait_for_rows()
{
    wait_until has_rows "$1" "$2"
}

# Repeats a check for a second, since a single one may happen in the middle of a
# frame.
expect()
{
    for _ in $(seq 20); do
        ! screen | grep -q -e "$1" || return 0
        sleep 0.05
    done
    die "not on the screen: $1"
}

reject()
{
    for _ in $(seq 20); do
        screen | grep -q -e "$1" || return 0
        sleep 0.05
    done
    die "on the screen: $1"
}

# Waits for the end with this status and checks that the terminal is restored.
# With "cleared" the earlier contents of the screen may be gone.
expect_end()
{
    wait_for "^exit $1\$"
    [ "${2-}" = cleared ] || expect "shell was here"
    cmp before after || die "other settings of the terminal than before"
    flags=$(mux display-message -p '#{alternate_on}#{mouse_any_flag}#{mouse_sgr_flag}#{keypad_cursor_flag}#{cursor_flag}')
    [ "$flags" = 00001 ] || die "modes were left on: $flags, expected 00001"
}

# Prints what each thread of the program waits for and how often it has slept. A
# sanitizer's own thread, which wakes by the clock, is left out.
waits()
{
    for task in "/proc/$1/task"/*; do
        echo "$(cat "$task/syscall")" \
            "$(awk '/ctxt_switches/ { printf "%s ", $2 }' "$task/status")"
    done | awk -v sleeps="$sleeps" 'index(sleeps, " " $1 " ") == 0'
}

# Succeeds if every thread waits without a time limit, so that only a key, a
# signal or a changed file wakes the program. Two equal states of all threads
# mean that none has run in between.
case $(uname -m) in
x86_64) ppoll=271 futex=202 sleeps=" 35 230 " ;;
aarch64) ppoll=73 futex=98 sleeps=" 101 115 " ;;
*) ppoll='' ;;
esac
rests()
{
    process=$(program_pid)
    if [ -z "$ppoll" ] || ! cat "/proc/$process/syscall" >/dev/null 2>&1; then
        echo "skip: threads cannot be watched here"
        return 0
    fi
    seen=$(waits "$process")
    [ "$seen" = "$(waits "$process")" ] || return 1
    echo "$seen" | awk -v ppoll=$ppoll -v futex=$futex '
        !($1 == ppoll && $4 == "0x0" || $1 == futex && $5 == "0x0") { n++ }
        END { exit n > 0 }'
}

program_pid()
{
    pgrep -P "$(mux display-message -p '#{pane_pid}')" glim
}

# Writes a scene whose only face is behind the camera: every pixel is the
# background, so all cells are known. 100x50 pixels; .5 .2 0 is 188 124 0 in
# sRGB.
flat_scene()
{
    printf 'v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n' >flat.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground .5 .2 0\n' >flat.view
}

# Writes an emitting triangle seen from the front: moving changes the picture.
# The only colours are the triangle's and black.
lamp_scene()
{
    printf 'newmtl l\nKd 0 0 0\nKe 1 1 1\n' >lamp.mtl
    printf 'mtllib lamp.mtl\nusemtl l\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n' \
        >lamp.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 0 0\n' >lamp.view
}
