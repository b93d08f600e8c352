# SPDX-License-Identifier: MIT
# Everything works in 40x12 cells; a smaller window shows a message.
flat_scene
size=40x12
start --cell-aspect 2 flat.obj
wait_for_rows 10 "48;2;188;124;0"
expect "LIVE"
keys '?'
wait_for "w *move forward"
keys End
wait_for "\^Q \^C *quit"
reject "move forward"
keys Home
wait_for "w *move forward"
keys Escape
wait_until_gone "move forward"
keys g # the window leaves the status line
wait_for "about this render"
expect "LIVE .*? help"
keys g
keys v
wait_for "\[+\]"
wait_for "nothing but the sky"
mux resize-window -x 39 -y 12
wait_for "needs 40x12, has 39x12"
mux resize-window -x 40 -y 11
wait_for "needs 40x12, has 40x11"
mux resize-window -x 80 -y 24
wait_for_rows 20 "48;2;188;124;0"
keys '?'
wait_for "w *move forward"
raw_keys 'leave' # another word for it
wait_for "\^Q \^C *quit"
reject "move forward"
keys Escape # the search, then the list
wait_for "move forward"
keys Escape
wait_until_gone "move forward"
keys C-q
expect_end 0
