# SPDX-License-Identifier: MIT
# Pause, one pass, restart; paused and done, every thread waits for
# a key; without decoration nothing but the picture is on the screen.
lamp_scene
size=100x21

has_picture_only()
{
    [ -z "$(screen | tr -d ' \n▀▄▂▆▖▗▘▙▚▛▜▝▞▟▌▐')" ]
}

start lamp.obj
wait_for "LIVE .* [1-9][0-9]* spp"
keys Enter
wait_for "LIVE paused"
wait_until rests
done_before=$(screen | sed -n 's/.*paused  filtered  \([0-9]*\) spp.*/\1/p')
keys .
wait_for "LIVE paused  filtered  $((done_before + 1)) spp"
keys . .
wait_for "LIVE paused  filtered  $((done_before + 3)) spp"
wait_until rests
keys Enter
wait_until_gone "paused"
wait_for "LIVE .* [1-9][0-9]* spp"
keys Enter 0 # from sample 0 on, and running
wait_until_gone "paused"
keys i
wait_until has_picture_only
keys i Enter
wait_for "LIVE paused"
keys w # a change goes on
wait_until_gone "paused"
keys Space . # normal mode, its first sample only
wait_for "NORMAL paused  1/16 spp"
keys .
wait_for "NORMAL paused  2/16 spp  12 %"
keys 0
wait_for "Unsaved render. Restart it?"
keys y
wait_for "NORMAL done  16/16 spp"
wait_until rests
keys .
wait_for "the render is done"
keys C-q
wait_for "Unsaved render. Quit?"
keys y
expect_end 0
