# SPDX-License-Identifier: MIT
# x writes the screen's cells as text, as batch mode does, and cat shows it. It
# never replaces a file.
flat_scene
start --cell-aspect 2 flat.obj
wait_for_rows 15 "48;2;188;124;0"
keys x
wait_for "saved flat.ans, text of 60x15 characters"
keys C
wait_for "256 colours"
keys x
wait_for "saved flat-2.ans, text of 60x15"
keys C-q
expect_end 0
expect "^saved flat.ans"
glim -b --ansi 60x20 flat.obj 2>/dev/null | cmp - flat.ans
glim -b --ansi 60x20 --color 256 flat.obj 2>/dev/null | cmp - flat-2.ans
fresh
start_line "cat flat.ans"
wait_for "^exit 0"
wait_for_rows 15 "48;2;188;124;0"
