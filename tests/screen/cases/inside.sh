# SPDX-License-Identifier: MIT
# Views of what is not light, and drawings over the picture. Two lamps fill it:
# the right one is wound away from the eye, and neither has uvs.
two_walls()
{
    printf 'newmtl red\nKd 0 0 0\nKe 3 0 0\n' >walls.mtl
    printf 'newmtl green\nKd 0 0 0\nKe 0 1 0\n' >>walls.mtl
    awk 'function wall(from, turned, x, y) {
        for (x = from; x < from + 20; x += 4)
            for (y = -20; y < 20; y += 4) {
                print "v", x, y, 0 "\nv", x + 4, y, 0
                print "v", x + 4, y + 4, 0 "\nv", x, y + 4, 0
                print turned ? "f -1 -2 -3 -4" : "f -4 -3 -2 -1"
            }
    }
    BEGIN {
        print "mtllib walls.mtl\nusemtl red"
        wall(-20, 0)
        print "usemtl green"
        wall(0, 1)
    }' >walls.obj
    printf 'eye 0 0 5\nat 0 0 0\nres 100 50\nbackground 0 0 0\nexposure -4\n' \
        >walls.view
}
has_colors() # true if the picture has as many different ones
{
    [ "$(screen_colors | head -n 15 | grep -o '48;2;[0-9;]*m' | sort -u | wc -l)" = "$1" ]
}
colors_are() # as many different ones, and these
{
    wait_until_gone "LIVE .* spp"
    count=$1
    shift
    for color; do
        wait_for_rows 15 "48;2;$color"
    done
    wait_until has_colors "$count"
}
two_walls
start --cell-aspect 2 walls.obj
wait_for "LIVE .* spp"
# a preview has its own exposure
keys n
wait_for "PREVIEW"
colors_are 2 "255;0;0" "0;255;0"
keys n
wait_for "NORMALS"
colors_are 1 "128;128;255"
keys n
wait_for "FACES"
colors_are 2 "128;128;255" "128;128;0"
# what is seen is what is saved, but not as light
keys p
wait_for "saved walls.png 100x50, as it is shown"
keys x
wait_for "saved walls.ans, text of 60x15 characters"
grep -q "48;2;128;128;255m" walls.ans
grep -q "48;2;128;128;0m" walls.ans
keys P
wait_for "only light is saved as hdr: Esc goes back"
wait_for "FACES"
keys n
wait_for "UVS"
colors_are 1 "64;64;64"
# of the middles of 60x30 pixels: 5 sqrt(1 + x^2 + y^2), where y reaches tan 20
keys n
wait_for "DEPTH  from 5[.0-9]*, white, to 6[.]4*[0-9.]*, dark"
keys n
wait_for "MATERIALS"
colors_are 2
keys n
wait_for "COST  tests of a camera ray, black 0, white [1-9]"
keys n
wait_for "SAMPLES  of a pixel, black 0, white [1-9]"
# samples of lamps are all equal
keys n
wait_for "ERROR  black 0.1 %, red 3, white 100 %; noise 0"
colors_are 1 "0;0;0"
keys N N N
wait_for "MATERIALS"
# moving restarts it
keys -N 30 w
wait_for "MATERIALS"
keys r n n n n
wait_for "LIVE"
# boxes
keys t
wait_for "boxes of level 1 of [2-9]: [2-8] boxes;"
keys '>'
wait_for "boxes of level 2 of"
keys '<' '<'
wait_for "boxes of level 1 of"
keys p
wait_for "saved walls-2.png 100x50, as it is shown"
cmp -s walls.png walls-2.png && die "boxes are not in the file"
# what is in the middle, until something is picked
keys t
wait_for "directions from pixel 50 25"
expect "^ Esc ends  t next drawing" # the window is above the row of keys
expect "green, seen [01].[0-9] degrees off n"
expect "n normal, green .* 0.000  *0.000  *1.000"
keys v Left Left Left Left Left Left Enter
wait_for "red, seen"
keys t
wait_for "sample 0 of pixel 40 2[0-9]"
expect "1  hits red, finds light, ends there"
expect "step 1 of 1; the path brings light 3 0 0"
keys t
expect "1 red .* end "
expect "step 1 of 1; the path brings light 3 0 0"
keys '>'
wait_for "sample 1 of pixel"
keys '<'
wait_for "sample 0 of pixel"
# help closes and opens it, a resize leaves it
keys '?'
wait_for "Esc back"
reject "sample 0 of"
keys Escape
wait_for "sample 0 of pixel"
mux resize-window -x 70 -y 25
wait_for "sample 0 of pixel"
keys t
wait_until_gone "sample 0 of"
keys '>'
wait_for "t draws them"
# normal mode has light, samples and errors
keys n
wait_for "PREVIEW"
keys Space
wait_for "normal mode"
keys n
wait_for "SAMPLES"
keys n
wait_for "ERROR  black 0.1 %, red 3, white 100 %; noise 0"
keys n
wait_until_gone "ERROR"
# tmux restores the shell's screen whole only at the size that it had
mux resize-window -x 60 -y 21
keys C-q
expect_end 0
