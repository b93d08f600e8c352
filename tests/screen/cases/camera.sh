# SPDX-License-Identifier: MIT
# Keys and mouse move the camera; c writes the view, r returns.
lamp_scene
view_of() # key, number of the eye or at value: presses it, prints the value
{
    keys "$1"
    rm -f lamp.view
    keys c # ends a move
    wait_for "wrote the view"
    rm -f lamp.view.old
    awk -v k="$2" -v n="$3" '$1 == k { print $(n + 1) }' lamp.view
    cp lamp.view lamp.view.old
    keys r
    wait_for "the view as it was opened"
}
moved() # key, eye or at, which number, < or >, of what
{
    got=$(view_of "$1" "$2" "$3")
    awk "BEGIN { exit !($got $4 $5) }" ||
        die "after $1 $2[$3] is $got, expected $4 $5"
}
# without the filter, which makes pixels of edges white earlier
start --no-filter lamp.obj
wait_for "▀"
is_silent()
{
    ! screen | grep -q "wrote the view"
}
rm lamp.view
keys c
wait_for "wrote the view"
cp lamp.view lamp.view.first
keys Escape
wait_until is_silent
moved w eye 3 '<' 4.99
moved s eye 3 '>' 5.01
moved a eye 1 '<' -0.01
moved d eye 1 '>' 0.01
moved Q eye 2 '<' -0.01
moved e eye 2 '>' 0.01
moved Up at 2 '>' 0.01
moved Down at 2 '<' -0.01
moved Left at 1 '<' -0.01
moved Right at 1 '>' 0.01
# a drag to the right turns to the right, as long as the mouse is on
drag=$(printf '\033[<0;20;10M\033[<32;30;10M\033[<0;30;10m')
raw_keys "$drag"
moved x at 1 '>' 0.1
keys m
wait_for "mouse off"
raw_keys "$drag"
keys c
wait_for "wrote the view"
cmp lamp.view lamp.view.first || die "the mouse turned the camera, which is off"
keys r
wait_for "the whole scene"
keys u
raw_keys '+'
wait_for "speed factor 1.25: "
# held: a way that no single tap makes
closer() # presses w; true when the triangle is as large as from 4 ahead
{
    keys w
    [ "$(rows_with '48;2;255;255;255')" -ge 13 ]
}
wait_until closer
moved w eye 3 '<' 4.5
keys C-q
expect_end 0
fresh
lamp_scene
start --phoe-keys lamp.obj
wait_for "▀"
moved w eye 2 '>' 0.01
moved Q eye 3 '<' 4.99
keys C-q
expect_end 0
