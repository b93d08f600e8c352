# SPDX-License-Identifier: MIT
# Keys and mouse turn around what is picked, as far from it as before.
lamp_scene
# Presses these keys and writes the view, all at once; the eye is as far from the
# point (0, 0, 0) as before, its x has this sign.
orbited()
{
    sign=$1
    shift
    rm -f lamp.view
    keys "$@" c
    wait_until test -s lamp.view
    awk -v sign="$sign" '$1 == "eye" {
        d = sqrt($2 * $2 + $3 * $3 + $4 * $4) - 5
        ok = d < 1e-3 && d > -1e-3 && sign * $2 > 0.1
    } END { exit !ok }' lamp.view || {
        cat lamp.view
        die "expected an eye 5 from the origin, $sign"
    }
}
start --cell-aspect 2 lamp.obj
wait_for "▀"
keys o
wait_for "orbit the centre"
orbited 1 Right Right Right
keys o
wait_for "look around"
keys u
wait_for "undone"
# the right button does so without the mode, and a plain one within it
raw_keys "$(printf '\033[<2;20;10M\033[<34;30;10M\033[<2;30;10m')"
orbited -1
keys r
wait_for "as it was opened"
keys o
raw_keys "$(printf '\033[<0;30;10M\033[<32;20;10M\033[<0;20;10m')"
orbited 1
wait_for "LIVE  orbit"
keys Escape # leaves it
wait_for "look around"
reject "LIVE  orbit"
keys C-q
expect_end 0
