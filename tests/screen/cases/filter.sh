# SPDX-License-Identifier: MIT
# Live mode filters light on the screen and says so; F and --no-filter show the
# noise. Other views and normal mode are not filtered. Views, the panel, another
# size and a comparison keep the samples.
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
# looking loses no sample
spp() # prints the samples of the status line
{
    screen | sed -n 's/^ LIVE.* \([0-9][0-9]*\) spp.*/\1/p'
}
has_more_than() # true if the picture is filtered and has more samples
{
    screen | grep -q "LIVE  filtered " && [ "$(spp)" -gt "$1" ]
}
before=$(spp)
keys n
wait_for "PREVIEW"
keys N
wait_until has_more_than "$before"
before=$(spp)
keys Tab
wait_for "Materials"
wait_until has_more_than "$before"
before=$(spp)
mux resize-window -x 90 -y 30
wait_until has_more_than "$before"
before=$(spp)
keys Escape K
wait_for "COMPARE"
keys Escape
wait_until has_more_than "$before"
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
