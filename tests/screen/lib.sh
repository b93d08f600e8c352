# SPDX-License-Identifier: MIT
# lib.sh - what the cases have in common
#
# A case runs in an empty folder; `start` opens a window of tmux in which the
# program runs, the other functions press keys and look. What does not come
# within half a minute fails. Nothing is awaited by the clock: after
# `wait_until rests` nothing happens by itself any more.

mux()
{
    tmux -u -S "$SOCKET" -f /dev/null "$@"
}

# Says what went wrong and ends the case.
die()
{
    echo "$*"
    exit 1
}

# Opens a window of $size cells with a shell that runs the given line. Before
# and after it the settings of the terminal are kept in files.
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

# Ends the window, for another one.
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

# Bytes as they are.
raw_keys()
{
    mux send-keys -l -- "$1"
}

screen()
{
    mux capture-pane -p
}

# With the colours as sequences, and blanks to the end of the rows.
screen_colors()
{
    mux capture-pane -p -e -N
}

# Rows that have this colour. The sequence stands only where colours change, so
# the colour is followed from cell to cell.
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

# Waits until the screen has a line that matches.
wait_for()
{
    tries=0
    until screen | grep -q -e "$1"; do
        tries=$((tries + 1))
        [ $tries -lt 600 ] || die "waited for: $1"
        sleep 0.05
    done
}

# Waits until so many rows have the colour.
wait_for_rows()
{
    tries=0
    until [ "$(rows_with "$2")" = "$1" ]; do
        tries=$((tries + 1))
        [ $tries -lt 600 ] ||
            die "waited for $1 rows of $2, found $(rows_with "$2")"
        sleep 0.05
    done
}

wait_until_gone()
{
    tries=0
    while screen | grep -q -e "$1"; do
        tries=$((tries + 1))
        [ $tries -lt 600 ] || die "waited for the end of: $1"
        sleep 0.05
    done
}

# Waits until the command says yes.
wait_until()
{
    tries=0
    until "$@"; do
        tries=$((tries + 1))
        [ $tries -lt 600 ] || die "waited for: $*"
        sleep 0.05
    done
}

# A look may fall into the middle of a frame: for a second it is taken again.
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

# Waits for the end with this status, and that everything is as before; with
# "cleared", what was on the screen may be gone.
expect_end()
{
    wait_for "^exit $1\$"
    [ "${2-}" = cleared ] || expect "shell was here"
    cmp before after || die "other settings of the terminal than before"
    flags=$(mux display-message -p '#{alternate_on}#{mouse_any_flag}#{mouse_sgr_flag}#{keypad_cursor_flag}#{cursor_flag}')
    [ "$flags" = 00001 ] || die "modes were left on: $flags, expected 00001"
}

# What each of the program's threads waits for, and how often it has slept. A
# sanitizer has a thread of its own that sleeps by the clock.
waits()
{
    for task in "/proc/$1/task"/*; do
        echo "$(cat "$task/syscall")" \
            "$(awk '/ctxt_switches/ { printf "%s ", $2 }' "$task/status")"
    done | awk -v sleeps="$sleeps" 'index(sleeps, " " $1 " ") == 0'
}

# True if every thread waits without a time limit: only a key, a signal or a
# changed file wakes the program, until then it neither computes nor writes. Two
# equal looks at all threads mean that none has run between them.
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

# Its only face is behind the camera: the picture is the background in every
# pixel, so the cells are known. 100x50 pixels; .5 .2 0 is 188 124 0 in sRGB.
flat_scene()
{
    printf 'v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n' >flat.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground .5 .2 0\n' >flat.view
}

# A triangle that shines, seen from the front: moving changes the picture. The
# seen colours are its own, exactly, and black.
lamp_scene()
{
    printf 'newmtl l\nKd 0 0 0\nKe 1 1 1\n' >lamp.mtl
    printf 'mtllib lamp.mtl\nusemtl l\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n' \
        >lamp.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 0 0\n' >lamp.view
}
