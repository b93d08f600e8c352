# SPDX-License-Identifier: MIT
# The panel opens and closes without clearing the screen; a picture that keeps
# its place is not sent again. What the screen shows then is compared in
# test_tty.c.
cp "$root"/scenes/cornell.* .
size=160x50
start -w 100 -h 100 cornell.obj
wait_for "LIVE .* [1-9][0-9]* spp"
keys Enter
wait_for "LIVE paused"
wait_until rests
mux pipe-pane 'cat >raw'
keys Tab
wait_for "│ Materials"
wait_until rests
keys Escape
wait_until_gone "│ Materials"
wait_until rests
mux pipe-pane
! grep -q "$(printf '\033')\[[0-3]*J" raw || die "the screen was cleared"
# the panel with its ball takes 30 kB, the picture more than 100, each time
[ "$(wc -c <raw)" -lt 60000 ] || die "$(wc -c <raw) bytes"
# on request it is cleared
mux pipe-pane 'cat >raw'
keys C-l
wait_until grep -q "$(printf '\033')\[J" raw
keys C-q
expect_end 0
