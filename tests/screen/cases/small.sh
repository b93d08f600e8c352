# SPDX-License-Identifier: MIT
# Everything works in 40x12 cells; a smaller window shows a message.
flat_scene
size=40x12
start --cell-aspect 2 flat.obj
wait_for_rows 10 "48;2;188;124;0"
expect "LIVE"
keys '?'
wait_for "keys 1/5 - any key goes on"
expect "w s *move forward, back"
keys x
wait_for "keys 2/5 - any key goes on"
keys Escape # closes it at once
wait_until_gone "any key"
keys '?' x x x x
wait_for "any key closes"
expect "q *quit"
keys x
wait_until_gone "any key"
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
wait_for "any key closes" # all on one page
expect "w s *move forward, back"
expect "q *quit"
keys x
keys q
expect_end 0
