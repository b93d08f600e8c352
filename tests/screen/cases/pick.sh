# SPDX-License-Identifier: MIT
# A cursor or a click picks what is seen; focus, lens and frame go by it.
two_lamps()
{
    printf 'newmtl red\nKd 0 0 0\nKe 1 0 0\n' >lamps.mtl
    printf 'newmtl green\nKd 0 0 0\nKe 0 1 0\n' >>lamps.mtl
    printf 'mtllib lamps.mtl\no left\nusemtl red\n' >lamps.obj
    printf 'v -2 -1 0\nv 0 -1 0\nv 0 1 0\nv -2 1 0\nf 1 2 3 4\n' >>lamps.obj
    printf 'o right\nusemtl green\n' >>lamps.obj
    printf 'v 2 -1 0\nv 2 1 0\nf 2 5 6 3\n' >>lamps.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 0 0\n' >lamps.view
}
# The named number of the view file is so, to a millionth.
is() # key, number of its value, value
{
    rm -f lamps.view
    keys c
    wait_until test -s lamps.view
    awk -v k="$1" -v n="$2" -v want="$3" '$1 == k {
        d = $(n + 1) - want
        ok = d < 1e-6 && d > -1e-6
    } END { exit !ok }' lamps.view || {
        cat lamps.view
        die "expected $1[$2] to be $3"
    }
}
two_lamps
start --cell-aspect 2 lamps.obj
wait_for "▀"
keys f
wait_for "nothing is picked"
keys v
wait_for "\[+\]"
wait_for "right / green, face 2, 5"
keys Left Left Left Left
wait_for "left / red, face 1, 5"
keys Up Up Up Up Up Up Up Up
wait_for "nothing but the sky"
keys Enter # picks nothing there
expect "\[+\]"
keys Down Down Down Down Down Down Down Down Enter
wait_for "left / red, face 1, .*o orbit"
wait_until_gone "\[+\]"
keys f
wait_for "focus at 5, once the lens is open"
is focus 1 5
keys '}'
wait_for "aperture "
keys '{' '{'
wait_for "pinhole lens"
keys z
wait_for "LIVE  left"
is at 1 -1
is at 2 0
is eye 1 -1
keys Z
wait_for "the whole scene"
is at 1 0
# a click in the right half, and one beside the picture
raw_keys "$(printf '\033[<0;40;10M\033[<0;40;10m')"
wait_for "right / green, face 2, "
raw_keys "$(printf '\033[<0;2;1M\033[<0;2;1m')"
keys z
wait_for "LIVE  right"
is at 1 1
keys v Escape
wait_until_gone "\[+\]"
# z picks what the cursor is on
keys r v Left Left Left Left Left Left z
wait_for "LIVE  left"
is at 1 -1
# o orbits what the cursor is on, even if it was on before
keys o v Right Right Right o
wait_for "orbit the picked point"
# in normal mode one can look, but not move
keys Space
wait_for "normal mode"
raw_keys "$(printf '\033[<0;30;10M\033[<0;30;10m')"
wait_for "left / red, "
raw_keys "$(printf '\033[<0;30;10M\033[<32;40;10M\033[<0;40;10m')"
wait_for "the camera moves only in live mode" # and nothing is picked there
keys f
wait_for "the camera moves only in live mode"
keys C-q
expect_end 0
fresh
# a cut-out of the picture: its middle is elsewhere
two_lamps
start --crop 0,0,50,50 --cell-aspect 2 lamps.obj
wait_for "▀"
keys v
wait_for "left / red, "
# the cursor stays in the corner
keys -N 60 Left
keys -N 30 Up
keys Left Up
wait_until eval 'screen | head -1 | grep -q "^ *+\]"'
keys C-q
expect_end 0
