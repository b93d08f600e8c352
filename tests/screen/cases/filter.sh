# SPDX-License-Identifier: MIT
# Live mode filters light on the screen and says so; F and --no-filter show the
# noise. Other views and normal mode are not filtered.
lamp_scene
size=100x21
start lamp.obj
wait_for "LIVE  filtered "
keys F
wait_for "the screen's picture is not filtered"
keys Escape
wait_for "LIVE  *[0-9]* spp"
keys F
wait_for "the screen's picture is filtered"
keys Escape
wait_for "LIVE  filtered "
keys n
wait_for "PREVIEW"
keys N
wait_for "LIVE  filtered "
keys Space Enter
wait_for "NORMAL done  16/16 spp"
keys C-q y
expect_end 0
fresh
start --no-filter lamp.obj
wait_for "LIVE  *[0-9]* spp"
keys F
wait_for "the screen's picture is filtered"
keys Escape
wait_for "LIVE  filtered "
keys C-q
expect_end 0
