# SPDX-License-Identifier: MIT
# K keeps a render: a wipe beside the present one, moved by keys and mouse, the
# differences, and a strip of what was kept. The lamp fills the picture, so that
# it has no noise.
printf 'newmtl l\nKd 0 0 0\nKe 1 0 0\n' >lamp.mtl
printf 'mtllib lamp.mtl\nusemtl l\nv -20 -20 0\nv 20 -20 0\nv 0 40 0\nf 1 2 3\n' \
    >lamp.obj
printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 0 0\n' >lamp.view
size=80x24
shows() # true if most rows have, or lack, red and green
{
    red=$(rows_with '48;2;255;0;0')
    green=$(rows_with '48;2;0;255;0')
    case $1 in
    both) [ "$red" -ge 15 ] && [ "$green" -ge 15 ] ;;
    red) [ "$red" -ge 15 ] && [ "$green" -le 4 ] ;;
    green) [ "$red" -le 4 ] && [ "$green" -ge 15 ] ;;
    esac
}
start --cell-aspect 2 lamp.obj
wait_for "LIVE .*[1-9][0-9]* spp"
keys y
wait_for "no render is kept: K keeps the present one"
keys K
wait_for "kept render 1: y shows differences, Esc ends"
# green now: the wipe has red at its left and green at its right
keys Tab Enter
wait_for "│>....type"
keys Down Down Down Down Down Down Down Down Down Down Down
wait_for "│>....of colour"
raw_keys '#0f0'
keys Enter
keys Escape Escape
wait_until_gone "│"
wait_until shows both
wait_for "COMPARE  left: kept 1 of 1, .* right: now"
# all of it is kept, or all is new
for _ in 1 2 3 4 5 6 7 8 9 10 11; do keys Left; done
wait_until shows green
for _ in $(seq 20); do keys Right; done
wait_until shows red
raw_keys "$(printf '\033[<0;40;12M\033[<0;40;12m')"
wait_until shows both
# a second one, of the same light, is not different
keys K
wait_for "kept render 2"
keys y
wait_for "DIFFERENCES  to kept 2 of 2 in 0.0 %: red is brighter, blue darker"
keys Up
wait_for "DIFFERENCES  to kept 1 of 2 in 100.0 %: red is brighter, blue darker"
# neither, and the camera has its keys again
keys Escape
wait_for "LIVE .* spp"
wait_until shows green
keys y
wait_for "COMPARE  left: kept 1 of 2"
keys y y
wait_for "LIVE .* spp"
keys C-q n C-q
wait_for "Unsaved changes. Quit?"
keys y
expect_end 0
