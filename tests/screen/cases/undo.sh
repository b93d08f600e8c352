# SPDX-License-Identifier: MIT
# Moves are undone one by one; numbered views are visited, kept and written.
lamp_scene
line() # of the view file that is written now; c ends a move
{
    rm -f lamp.view
    keys c
    wait_until test -s lamp.view
    grep "^$1" lamp.view
}
start --cell-aspect 2 lamp.obj
wait_for "▀"
keys u
wait_for "nothing to undo"
# held for a while, and a drag: two moves
keys -N 20 w
forward=$(line eye)
raw_keys "$(printf '\033[<0;20;10M\033[<32;30;10M\033[<32;40;10M\033[<0;40;10m')"
[ "$(line at)" != "at 0 0 0" ] || die "the drag turned nothing"
keys u
wait_for "undone: camera"
[ "$(line eye)" = "$forward" ] || die "the drag was not undone: $(line eye), expected $forward"
keys u
[ "$(line eye)" = "eye 0 0 5" ] || die "not back: $(line eye)"
[ "$(line at)" = "at 0 0 0" ] || die "not back: $(line at)"
keys U
wait_for "redone: camera"
[ "$(line eye)" = "$forward" ] || die "not forth: $(line eye)"
keys u
# a field of view, with the wheel too
raw_keys "]"
wait_for "field of view 4[0-9]"
keys u
raw_keys "$(printf '\033[<80;20;10M')"
wait_for "field of view 3[0-9]"
keys u
wait_for "undone"
[ "$(line fovy)" = "fovy 40" ] || die "not back: $(line fovy)"
keys 3
wait_for "view 3 is not set"
keys Escape Enter
wait_for "LIVE paused"
keys k
wait_for "Number for this view"
wait_until rests # the question has no time limit
expect "Number for this view? 1 to 9; others cancel"
keys 3
wait_for "stored as view 3"
keys k x 4 # the x is no number: nothing is kept
wait_for "view 4 is not set"
keys s
[ "$(line eye)" != "eye 0 0 5" ] || die "not moved"
keys 3
wait_for "  view 3"
[ "$(line eye)" = "eye 0 0 5" ] || die "not at view 3: $(line eye)"
want="view 3 eye 0 0 5 at 0 0 0 up 0 1 0 fovy 40 aperture 0 focus 0"
[ "$(line 'view 3')" = "$want" ] || die "found $(line 'view 3')"
keys C-q
expect_end 0
fresh
# from the file
printf 'view 7 eye 0 0 9 at 0 0 0\n' >>lamp.view
start lamp.obj
wait_for "▀"
keys 7
wait_for "  view 7"
[ "$(line eye)" = "eye 0 0 9" ] || die "not at view 7: $(line eye)"
keys r
wait_for "as it was opened"
[ "$(line 'view 7' | cut -c -18)" = "view 7 eye 0 0 9 a" ] || die "view 7 is lost"
keys C-q
expect_end 0
