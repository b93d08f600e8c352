# SPDX-License-Identifier: MIT
# The cells of a picture that is known: 2:1 in 60x20 cells of 1:2 is 60x15.
flat_scene
start --cell-aspect 2 flat.obj
wait_for "LIVE .* spp"
wait_for_rows 15 "48;2;188;124;0"
# the bar of five rows is below the picture, and has the noise and the keys
wait_for "noise [a-z ]*  .* [0-9.]* k*M*samples/s"
wait_for "wasdqe move"
screen_colors >colors
[ "$(grep -n '48;2;188;124;0m' colors | head -n 1 | cut -d: -f1)" = 1 ] ||
    die "not at the top"
# each row is 60 blanks in one colour, and nothing else
[ "$(sed -n 1,15p colors | sed 's/.\[[0-9;]*m//g' | grep -c '^ \{60\}$')" = 15 ] ||
    die "not 60 blanks a row: $(cat colors)"
[ "$(head -n 15 colors | grep -o '48;2;[0-9;]*m' | sort -u | wc -l)" = 1 ] ||
    die "more than one colour"
# without the status line there is room for 21 rows, of which 15 are used
keys i
wait_until_gone "LIVE"
wait_for_rows 15 "48;2;188;124;0"
keys i
wait_for "LIVE"
keys C-q
expect_end 0
# in a wide window it is beside the picture, at the right
fresh
size=90x21
start --cell-aspect 2 flat.obj # 80x20 cells: no room beside it
wait_for "LIVE .* spp"
wait_for_rows 20 "48;2;188;124;0"
mux resize-window -x 128 -y 25
wait_for "  noise [a-z ]*$"
wait_for "  wasdqe move$"
wait_for "  arrows look$"
screen_colors | head -n 24 >colors
[ "$(grep -c '48;2;188;124;0m \{96\}.\[38' colors)" = 24 ] ||
    die "not 96 blanks at the left: $(cat colors)"
keys C-q
expect_end 0
