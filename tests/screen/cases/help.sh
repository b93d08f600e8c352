# SPDX-License-Identifier: MIT
# ? opens the help over the picture, which is darker behind it; letters search
# and do nothing else, Esc closes.
flat_scene
size=120x30
start flat.obj
wait_for_rows 29 "48;2;188;124;0"
keys '?'
wait_for "save a new PNG file"
expect "Q e *move down, up"
expect "Esc closes"
expect "half blocks, [0-9.]* ms away" # whole: it fits into its column
# no picture shines through the window
row=$(screen_colors | grep "save a new PNG")
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
wait_for "search: png_"
expect "save a new PNG"
reject "move down"
keys Escape
wait_until_gone "search"
wait_for_rows 29 "48;2;188;124;0"
reject "save a new PNG"
keys '?'
wait_for "Esc closes"
keys q # is searched for, does not quit
wait_for "search: q_"
keys Enter
wait_until_gone "search"
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
