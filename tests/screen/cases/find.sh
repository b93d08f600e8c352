# SPDX-License-Identifier: MIT
# Names in the panel's list are found by some letters; Home and End; what the
# row of the selected one is; which text a value takes.
for i in $(seq 203); do
    printf 'newmtl part%s\nKd .5 .5 .5\nKe .1 .1 .1\n' "$i"
done >many.mtl
{
    echo "mtllib many.mtl"
    for i in $(seq 203); do
        printf 'usemtl part%s\nv %s -30 0\nv %s 30 0\nv 100 40 0\nf -1 -2 -3\n' \
            "$i" "$i" "$i"
    done
} >many.obj
printf 'eye 100 0 150\nat 100 0 0\nres 100 50\n' >many.view
size=80x30
start many.obj
wait_for "LIVE .* spp"
keys Tab
wait_for "part1 .* 1 of 203"
keys End
wait_for "part203 .* 203 of 203"
keys Home
wait_for "part1 .* 1 of 203"
raw_keys "/"
wait_for "find: _"
raw_keys "T19"
wait_for "part19 .* 19 of 203"
keys Enter
wait_for "part190 .* 190 of 203"
keys Enter
wait_for "part191 .* 191 of 203"
raw_keys "x"
wait_for "no name has 'T19x'"
keys BSpace Escape
wait_until_gone "find:"
expect "part191 .* 191 of 203"
keys Enter Down Down Down 0
wait_for "│ 0 to 1$"
keys Escape Up 0
wait_for "#rrggbb, r g b"
keys Escape
# a colour has no steps, and says so
expect "Enter types it"
keys Right
wait_for "Enter types a colour; the arrows change the rows below"
# what is picked is outlined, without the panel, too
keys Escape Escape
wait_until_gone "part191"
is_outlined() # true if some cells show the colour of the outline
{
    escape=$(printf '\033')
    screen_colors | grep -Eq \
        "48;2;255;154;46m|38;2;255;154;46m($escape\[48;[0-9;]*m)?[^ $escape]"
}
wait_until eval "! is_outlined"
keys v Enter
wait_until is_outlined
keys C-q
expect_end 0
