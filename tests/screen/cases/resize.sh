# SPDX-License-Identifier: MIT
# The window may have any size at any time; if it is too small, a message says
# so.
flat_scene
start --cell-aspect 2 flat.obj
wait_for_rows 15 "48;2;188;124;0"
mux resize-window -x 100 -y 41
wait_for_rows 25 "48;2;188;124;0"
mux resize-window -x 100 -y 12
wait_for_rows 11 "48;2;188;124;0"
mux resize-window -x 15 -y 8
wait_for "needs 40x12"
mux resize-window -x 40 -y 2
wait_for "needs 40x12, has 40x2"
keys w # does nothing here
mux resize-window -x 60 -y 21
wait_for_rows 15 "48;2;188;124;0"
for i in 1 2 3 4 5 6 7 8 9; do
    mux resize-window -x $((20 + 9 * i)) -y $((5 + 3 * i))
done
mux resize-window -x 60 -y 21
wait_for_rows 15 "48;2;188;124;0"
wait_for "LIVE"
# The help stays open: tmux may tell the program of a size after the key.
keys '?'
wait_for "Esc back"
raw_keys 'png'
wait_for ": png_"
mux resize-window -x 39 -y 31
wait_for "needs 40x12, has 39x31"
keys x # is not searched for
mux resize-window -x 80 -y 31
wait_for ": png_"
expect "save a PNG"
keys Escape Escape
wait_until_gone "save a PNG"
wait_for_rows 20 "48;2;188;124;0"
# A terminal that had another size for a moment lost cells.
mux send-keys -R
wait_for_rows 0 "48;2;188;124;0"
kill -WINCH "$(program_pid)"
wait_for_rows 20 "48;2;188;124;0"
mux resize-window -x 39 -y 31
wait_for "has 39x31"
keys C-q
expect_end 0
