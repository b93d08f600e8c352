# SPDX-License-Identifier: MIT
# Normal mode starts, halts, continues and ends, and asks before a picture is
# lost. The program sleeps when nothing changes.
lamp_scene
size=100x21
start -s 5 lamp.obj
wait_for LIVE
keys Space
wait_for "normal mode: Enter starts the render"
keys w
wait_for "the camera moves only in live mode"
wait_for "NORMAL ready"
keys q # nothing was rendered: no question
expect_end 0
fresh
start -s 5 lamp.obj
wait_for LIVE
keys Space Enter
wait_for "NORMAL done  5/5 spp  100 %"
wait_until rests
keys Enter
wait_for "the render is done"
keys q
wait_for "The render is not saved. Quit?"
keys n
wait_for "NORMAL done"
keys Space
wait_for "The render is not saved. Leave it?"
keys n
wait_for "NORMAL done"
keys p
wait_for "saved lamp.png 100x50, 5 spp"
keys q
expect_end 0
expect "^saved lamp.png 100x50, 5 spp"
[ "$(head -c 8 lamp.png | od -An -c | tr -d ' ')" = '211PNG\r\n032\n' ] ||
    die "lamp.png is no PNG"
fresh
start -s 1000000000 lamp.obj
wait_for LIVE
keys Space Enter
wait_for "NORMAL  [1-9][0-9]*/1000000000 spp"
keys Enter
wait_for "NORMAL paused"
wait_until rests # a halted render does not go on
expect "NORMAL paused"
keys Enter
wait_for "NORMAL  [1-9]"
keys q
wait_for "The render is not saved. Quit?"
keys y
expect_end 0
