# SPDX-License-Identifier: MIT
# The panel: a lamp gets another colour, live; undo, compare, save; a copy for
# an object; sky and exposure; at 80x24 and in monochrome.
lamp_scene
printf '# mine\nnewmtl l\nKd 0 0 0 # black\nKe 1 1 1\naniso .5\n' >lamp.mtl
size=80x24
shows() # colour of the triangle, as R;G;B
{
    wait_until eval "screen_colors | sed 's,│.*,,' | grep -q '[34]8;2;$1m'"
}
start lamp.obj
wait_for LIVE
shows '255;255;255'
keys Tab
wait_for "│ Materials  Objects  Light "
expect "│>....l                 diffuse"
# the values are under the list, without a gap
screen | sed -n 3p | grep -q '│─ l ─' || die "row 3: $(screen | sed -n 3p)"
screen | sed -n 4p | grep -q '│     type ' || die "row 4: $(screen | sed -n 4p)"
expect "     light      1        ███▋"
wait_for "LIVE"
# the help begins with the panel's own keys
keys '?'
wait_for "arrows *choose; change by a step"
keys Escape
wait_until_gone "choose; change"
# by hand: red light, typed
keys Enter
keys Down Down Down Down Down Down Down Down Down Down Down
wait_for "^.*│>....of colour  #ffffff"
raw_keys '#ff0000'
wait_for "of colour  #ff0000_"
keys Enter
shows '255;0;0'
expect " l \*"
# the camera still moves
keys w c
wait_for "Change lamp.view?"
keys y
wait_for "wrote the view"
expect "│>....of colour  #ff0000"
# a type is not typed: Enter goes to the next, and back with the undo
keys Up Up Up Up Up Up Up Up Up Up Up
wait_for "│>....type       diffuse"
keys 5
wait_for "changed with the arrows, or Enter"
keys Enter
wait_for "│>....type       [^d ]"
keys u
wait_for "│>....type       diffuse"
keys Down Down Down Down Down Down Down Down Down Down Down
wait_for "│>....of colour  #ff0000"
# half as bright by the arrows: one step of undo
keys Up
keys Left Left Left
wait_for "│>....light      0.751"
keys u
wait_for "│>....light      1   "
wait_for "undone: material l"
# the camera's move, the colour before it
keys u
wait_for "undone: camera"
expect "of colour  #ff0000"
keys u
shows '255;255;255'
keys u
wait_for "nothing to undo"
keys U
shows '255;0;0'
# compare with what is saved
raw_keys '\'
wait_for 'as saved: . goes back'
shows '255;255;255'
raw_keys '\'
shows '255;0;0'
# quitting asks, saving changes only what was changed
keys C-q
wait_for "Unsaved changes. Quit?"
keys n
wait_for LIVE
keys C-s
wait_for "wrote 1 material to lamp.mtl"
printf '# mine\nnewmtl l\nKd 0 0 0 # black\nKe 1 0 0\naniso .5\n' |
    cmp - lamp.mtl || die "lamp.mtl: $(cat lamp.mtl)"
# a copy for the object, in green
keys Tab
wait_for "─ (no name) / l "
expect "│>....(no name)         l$"
keys IC
wait_for "has its own material now: l.2"
keys Tab Tab
wait_for "│>....l.2               diffuse"
keys Enter Down Down Down Down Down Down Down Down Down Down Down
raw_keys '#0f0'
keys Enter
shows '0;255;0'
keys C-s
wait_for "wrote 1 material to lamp.mtl, and lamp.view"
grep -q '^assign "" l.2$' lamp.view || die "lamp.view: $(cat lamp.view)"
# sky and exposure
keys Escape
wait_for "Ins copy"
keys Tab Tab
wait_for "─ Sky and picture"
expect "│>....sun        off"
keys Enter
wait_for "│ off or on"
keys Escape Right
wait_for "│>....sun        on"
expect "     elevation  45       █████▌"
expect "     strength   1"
keys Down Down
raw_keys '91'
keys Enter
wait_for "found '91', expected a number from -90 to 90"
keys Escape
wait_until_gone "91_"
keys ')'
wait_for "│>....elevation  55"
keys Up Up Left
wait_for "│>....sun        off"
keys Down Down
raw_keys '0 0 1'
keys Enter
wait_until eval "screen_colors | grep -q '[34]8;2;0;0;255m'"
keys Down Down Down Down
raw_keys '-1'
keys Enter
wait_until eval "screen_colors | grep -q '[34]8;2;0;0;188m'"
# nonsense is refused
raw_keys '1x'
keys Enter
wait_for "found '1x', expected a number from -100 to 100"
keys Escape Escape
wait_until_gone "│"
keys C-q
wait_for "Unsaved changes. Quit?"
keys s
expect_end 0
grep -q '^exposure -1$' lamp.view || die "lamp.view: $(cat lamp.view)"
# the mouse: a material, a value, the wheel, another page
fresh
start lamp.obj
wait_for LIVE
keys Tab
wait_for "│>....l  "
click=$(printf '\033[<0;%d;%dM\033[<0;%d;%dm' 55 3 55 3)
raw_keys "$click"
wait_for "│>....l\.2 "
raw_keys "$(printf '\033[<0;60;15M\033[<0;60;15m')"
wait_for "│>....light "
raw_keys "$(printf '\033[<65;60;15M')"
wait_for "│>....light      0.909"
# a slider is dragged, and one undo takes the whole drag back
raw_keys "$(printf '\033[<0;70;8M')"
wait_for "│>....red        0\.[0-9]"
raw_keys "$(printf '\033[<32;78;8M')"
wait_for "│>....red        0\.86"
raw_keys "$(printf '\033[<32;90;23M\033[<0;90;23m')"
wait_for "│>....red        1 "
keys u
wait_for "│>....red        0 "
raw_keys "$(printf '\033[<0;66;1M\033[<0;66;1m')"
wait_for "Sky and picture"
keys u
wait_for "Sky and picture ─"
keys Escape
wait_until_gone "│"
# a click on the picture selects what is there
keys Tab
wait_for "Sky and picture"
raw_keys "$(printf '\033[<0;22;8M\033[<0;22;8m')"
wait_for "│>....l\.2 "
keys C-q
expect_end 0
# it is all there again; monochrome has the numbers
fresh
size=40x12
start --color mono lamp.obj
wait_for "LIVE"
keys Tab
wait_for "│>.*l "
# the panel takes the whole window
[ "$(screen | grep -c '^│')" = 11 ] || die "not in the whole window"
keys Down
wait_for "│>.*l\.2 "
keys Enter Down Down
wait_for "│>.*colour     #"
keys Escape Escape
wait_until_gone "│"
keys C-q
expect_end 0
# white beside the light theme's paper: its swatch has edges of another colour
fresh
size=80x24
printf 'newmtl l\nKd 1 1 1\n' >lamp.mtl
start --theme light lamp.obj
wait_for LIVE
keys Tab
wait_for "│>▕  ▏l  "
screen_colors | grep 'colour  ' |
    grep -q '38;2;124;133;145m▕.*48;2;255;255;255m  .*▏' ||
    die "swatch: $(screen_colors | grep 'colour  ' | cat -v)"
keys C-q
expect_end 0
# in normal mode nothing moves or is edited; the row of keys knows
fresh
size=80x30
start --cell-aspect 2 lamp.obj
wait_for "LIVE .* spp"
keys Tab
wait_for "^ wasdqe move"
keys Space
wait_for "^ space live mode"
expect "│ space live mode, to edit"
reject "wasdqe"
keys C-q
expect_end 0
