# SPDX-License-Identifier: MIT
# The cells of a picture that is known: 2:1 in 60x20 cells of 1:2 is 60x15.
flat_scene
start --cell-aspect 2 flat.obj
wait_for "LIVE .* spp"
wait_for_rows 15 "48;2;188;124;0"
screen_colors >colors
# the picture begins behind two empty rows: (20 - 15) / 2
[ "$(grep -n '48;2;188;124;0m' colors | head -n 1 | cut -d: -f1)" = 3 ] ||
    die "not centred"
# each row is 60 blanks in one colour, and nothing else above the last two rows
[ "$(sed -n 3,17p colors | sed 's/.\[[0-9;]*m//g' | grep -c '^ \{60\}$')" = 15 ] ||
    die "not 60 blanks a row: $(cat colors)"
[ "$(head -n -2 colors | grep -o '48;2;[0-9;]*m' | sort -u | wc -l)" = 1 ] ||
    die "more than one colour"
# without the status line there is room for 21 rows, of which 15 are used
keys i
wait_until_gone "LIVE"
wait_for_rows 15 "48;2;188;124;0"
keys i
wait_for "LIVE"
keys q
expect_end 0
