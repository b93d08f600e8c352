# SPDX-License-Identifier: MIT
# The list of the numbered views, with a picture of the selected one.
lamp_scene
size=80x24
start lamp.obj
wait_for "LIVE .* spp"
raw_keys "'"
wait_for "no view has a number: k gives this one a number"
keys k 3
wait_for "stored as view 3"
keys -N 10 w
keys k 5
wait_for "stored as view 5"
raw_keys "'"
wait_for "3 *from 0 0 5, 40 degrees"
expect "5 *from 0 0 [0-9.]*, 40 degrees"
# the lamp is brighter than the ground of the window
pane_is_bright()
{
    screen_colors | grep "from 0 0\|^.*│" | grep -q "8;2;2[0-9]*;2[0-9]*;2[0-9]*m"
}
wait_until pane_is_bright
raw_keys "3"
wait_for ": 3_  *1 of 2\|: 3_  *2 of 2"
keys Escape
wait_for ": _  *2"
keys Down Enter
wait_for "view 5"
raw_keys "'"
wait_for "from 0 0 5, 40 degrees"
mux resize-window -x 60 -y 20 # without room for the picture
wait_for "from 0 0 5, 40 degrees"
keys Home Enter
wait_for "view 3"
keys C-q
expect_end 0
