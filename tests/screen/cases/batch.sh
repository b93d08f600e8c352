# SPDX-License-Identifier: MIT
# Keys that arrive together, as over a slow line, act as they do one by one.
size=100x21
wall() # the picture is 188 188 0 in every pixel
{
    printf 'newmtl w\nKd 0 0 0\nKe .5 .5 0\n' >wall.mtl
    printf 'mtllib wall.mtl\nusemtl w\nv -90 -90 0\nv 90 -90 0\nv 90 90 0\n' \
        >wall.obj
    printf 'v -90 90 0\nf 1 2 3 4\n' >>wall.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\n' >wall.view
}
YELLOW="48;2;188;188;0"
written() # keys that end with c: the view that they write
{
    rm -f wall.view
    keys "$@"
    wait_until test -s wall.view
    cat wall.view
}
wall
glim -b -s 1 -o reference.png wall.obj 2>/dev/null
start wall.obj
wait_for_rows 20 "$YELLOW"
# a tap is as long as ever, whatever key comes at once
at_once=$(written Right w c)
wait_for "wrote the view"
keys Escape Enter
wait_for "LIVE paused"
wait_until rests
[ "$(written c)" = "$at_once" ] || die "moved on: $(cat wall.view) after $at_once"
keys u U
[ "$(written c)" = "$at_once" ] || die "other moves again: $(cat wall.view)"
wait_for "wrote the view"
# a change goes on, and then it is paused
keys s Enter
wait_for "LIVE paused"
wait_until rests
expect "LIVE paused"
keys s .
wait_for "LIVE paused  filtered  [1-9][0-9]* spp"
wait_until rests
expect "LIVE paused"
keys Enter
wait_until_gone "paused"
# what is saved as light is light
keys n n
wait_for "NORMALS"
keys N N p
wait_for "nothing to save yet\|saved wall.png"
[ ! -e wall.png ] || glim compare wall.png reference.png >compared ||
    die "normals were saved: $(cat compared)"
keys n n
wait_for "NORMALS"
keys Space
wait_for "normal mode"
wait_until eval "! screen_colors | grep -q '48;2;188;188;255m'"
keys Space
wait_for_rows 20 "$YELLOW"
# a number is for the question, not for the value
keys Tab Enter
wait_for "│>....type"
keys Down Down k 5
wait_for "stored as view 5"
expect "│>....colour     #000000$"
# Esc is Esc
raw_keys "$(printf '\033\033\021')"
expect_end 0
fresh
# an error that comes while somebody types is seen
start_line "(ulimit -f 0; trap '' XFSZ; TERM=tmux-256color exec glim wall.obj)"
wait_for "LIVE .* [1-9][0-9]* spp"
keys p
wait_for "wall.*png: File to"
keys g
wait_for "about this render"
expect "wall.*png: File to"
wait_for "LIVE .* spp" # at its time
keys C-q
expect_end 0
