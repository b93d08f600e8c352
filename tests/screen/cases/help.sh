# SPDX-License-Identifier: MIT
# ? opens the help over the picture, any key closes it and does nothing else.
flat_scene
size=100x30
start flat.obj
wait_for_rows 25 "48;2;188;124;0"
keys '?'
wait_for "save a new PNG file"
expect "Q e *move down, up"
expect "any key closes"
expect "half blocks, [0-9.]* ms away" # whole: it fits into its column
# no picture shines through the window
row=$(screen_colors | grep "save a new PNG")
inside=${row#*│}
inside=${inside%│*}
case $inside in
*"48;2;"*) die "picture inside the window: $inside" ;;
esac
keys '~'
wait_until_gone "any key closes"
wait_for_rows 25 "48;2;188;124;0"
reject "save a new PNG"
keys '?'
wait_for "any key closes"
keys q # closes the help, does not quit
wait_until_gone "any key closes"
expect "LIVE"
keys q
expect_end 0
fresh
start --phoe-keys flat.obj
wait_for LIVE
keys F1
wait_for "s w *move down, up"
expect "Q e *move forward, back"
keys C-c
expect_end 130
