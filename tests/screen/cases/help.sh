# SPDX-License-Identifier: MIT
# ? and : open the list of commands over the picture, which is darker behind it;
# letters search, Enter and the mouse run a command, Esc goes back.
flat_scene
size=120x30
start flat.obj
wait_for_rows 29 "48;2;188;124;0"
keys '?'
wait_for "frame the picked object"
expect "q PgDn *move down"
expect "Esc back"
# no picture shines through the window
row=$(screen_colors | grep "frame the picked")
inside=${row#*│}
inside=${inside%│*}
case $inside in
*"48;2;75;49;0"* | *"48;2;188"*) die "picture inside the window: $inside" ;;
esac
# 2/5 of the picture's colour
is_dim()
{
    [ "$(rows_with '48;2;75;49;0')" -ge 4 ]
}
wait_until is_dim
raw_keys 'png'
wait_for ": png_ *2 of "
expect "save a PNG"
reject "move down"
keys Escape # ends the search
wait_for "move down"
keys Escape
wait_until_gone "move down"
wait_for_rows 29 "48;2;188;124;0"
# a command runs; words of people find it
raw_keys ':denoise'
wait_for "F *filter noise, or show it"
keys Enter
wait_for "the screen's picture is"
wait_until_gone "denoise"
raw_keys ':xyzzy'
wait_for "nothing is called that"
keys Enter # runs nothing
expect "nothing is called that"
keys Escape Escape
wait_until_gone "nothing is called that"
# the list scrolls with the selection
keys '?' End
wait_for "\^Q \^C *quit"
keys Escape
wait_until_gone "\^Q \^C"
wait_until_gone "picture is"
# Esc at the top level: the menu
keys Escape
wait_for "Esc *go on"
expect "\^Q \^C *quit"
reject "move forward"
keys q # is searched for, moves nothing
wait_for ": q_"
keys Escape Escape
wait_until_gone "go on"
# a press of the mouse runs a command: rows count from 1
keys Escape
wait_for "Esc *go on"
wait_for "all commands and keys" # all of the menu is there
y=$(screen | grep -n "all commands and keys" | cut -d: -f1)
raw_keys "$(printf '\033[<0;60;%dM\033[<0;60;%dm' "$y" "$y")"
wait_for "move forward"
raw_keys "$(printf '\033[<0;2;2M\033[<0;2;2m')" # beside it: closes
wait_until_gone "move forward"
expect "LIVE"
keys Escape Up Down Down Down Down Down Enter # quits by the menu
expect_end 0
fresh
start --phoe-keys flat.obj
wait_for LIVE
keys F1
wait_for "s PgDn *move down"
expect "q *move forward"
keys C-c
expect_end 0
