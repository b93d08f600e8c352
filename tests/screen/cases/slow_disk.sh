# SPDX-License-Identifier: MIT
# The screen answers keys while a disk is slow, is left at once, and says what it
# waits for: then ^C ends the program. After a disk that was full, files are
# written again.
library=$(dirname "$(command -v glim)")/faults/fault.so
[ -e "$library" ] || {
    echo 'no faults with sanitizers'
    exit 77
}
size=100x24
cp "$root"/scenes/cornell.* .
XDG_STATE_HOME=$PWD/state
export XDG_STATE_HOME
begin()
{
    : >disk
    start_line "FAULT_DISK=$PWD/disk LD_PRELOAD=$library TERM=tmux-256color \
        glim -w 64 -h 36 cornell.obj"
    wait_for "LIVE .* spp"
}
# Returns the time in milliseconds.
now()
{
    echo $(($(date +%s%N) / 1000000))
}
# Presses keys and checks that the window about the render opens and closes
# before the disk answers.
answers()
{
    echo 'slow 8000' >disk
    begin_ms=$(now)
    keys "$@" g
    wait_for 'about this render'
    keys g
    wait_until_gone 'about this render'
    [ $(($(now) - begin_ms)) -lt 7500 ] || die "$* wait for the disk"
    : >disk
}

begin
answers G
answers x
wait_for "saved cornell.ans, text of "
echo 'fails 28' >disk
keys x
wait_for 'cornell-2.ans: No space left on device'
keys p
wait_for 'cornell.png: No space left on device'
: >disk
keys p
wait_for 'saved cornell.png 64x36'
echo 'slow 60000' >disk
keys p
wait_for 'saving'
keys C-q
wait_for 'quits when the picture is saved'
keys w # it stays
keys C-q C-q
wait_for '^glim: files are being written; ^C ends without them'
expect 'shell was here'
keys C-c
wait_for '^^Cexit 130$'
cmp before after || die "other settings of the terminal than before"
[ "$(ls -A cornell*png)" = cornell.png ] || die "pictures: $(ls -A)"
