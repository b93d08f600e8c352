# SPDX-License-Identifier: MIT
# The scene that `make run` opens, at its own size.
size=140x45
start "$root/scenes/cornell.obj"
wait_for "LIVE .* [1-9][0-9]* spp"
wait_for "▀"
screen_colors | grep -q '38;2;' || die "no 24-bit colours"
[ "$(mux display-message -p '#{alternate_on}')" = 1 ] || die "no second screen"
mux resize-window -x 60 -y 20
wait_for "▀"
wait_for "LIVE"
keys C-q
expect_end 0
