# SPDX-License-Identifier: MIT
# Everything works in 40x12 cells; a smaller window shows a message.
flat_scene
size=40x12
start --cell-aspect 2 flat.obj
wait_for_rows 10 "48;2;188;124;0"
expect "LIVE"
keys '?'
wait_for "keys 1/9"
expect "w s *move forward, back"
keys Down
wait_for "keys 2/9"
keys Escape
wait_until_gone "keys 2/9"
keys '?' Up
wait_for "keys 9/9"
expect "q *quit"
keys Enter
wait_until_gone "keys 9/9"
keys g # the window leaves the status line
wait_for "progress"
expect "LIVE .*q quit"
keys g
keys v
wait_for "\[+\]"
wait_for "nothing but the sky"
mux resize-window -x 39 -y 12
wait_for "window 39x12: at least 40x12 is needed"
mux resize-window -x 40 -y 11
wait_for "window 40x11: at least 40x12 is needed"
mux resize-window -x 80 -y 24
wait_for_rows 20 "48;2;188;124;0"
keys '?'
wait_for "keys 1/2"
expect "w s *move forward, back"
raw_keys 'quit' # a search: one page
wait_for "search: quit_"
expect "q *quit"
reject "move forward"
keys Escape
wait_until_gone "search"
keys q
expect_end 0
