# SPDX-License-Identifier: MIT
# Media: a substance by its name, and its density; the fog of the view. Both are
# undone and saved, and files change in what was edited only.
lamp_scene
printf '# mine\nnewmtl l\nKd 0 0 0 # black\nKe 1 1 1\n' >lamp.mtl
size=80x34
start lamp.obj
wait_for LIVE
keys Tab
wait_for "│     preset     none"
keys Enter Down
wait_for "│>    preset     none"
keys Enter
wait_for "│ a name such as marble"
raw_keys 'gold'
keys Enter
wait_for "found 'gold', expected a name such as marble"
keys Escape
wait_until_gone "gold_"
# the row stays where it is, and its own values come below it
keys Right
wait_for "│>    preset     milk"
expect "│     type       plastic"
expect "▏colour     #faf8f0"
expect "│     subsurface 1"
keys u
wait_for "│>    preset     none"
expect "│     type       diffuse"
keys Enter
raw_keys 'jade'
keys Enter
wait_for "│>    preset     jade"
expect "│     mean path  0.177 0.167 0.187"
keys C-s
wait_for "wrote 1 material to lamp.mtl"
cat >expected.mtl <<'END'
# mine
newmtl l
Kd 0.4382342 0.79543114 0.5311563 # black
Ke 1 1 1
Ks 0.5 0.5 0.5
Sr 0.17719299 0.16666667 0.18703704
Pr 0.15
Sf 1
END
cmp expected.mtl lamp.mtl || die "lamp.mtl: $(cat lamp.mtl)"
# the fog of the view
keys Tab Tab Down Down Down Down Down Down Down Down
wait_for "│>    fog        off"
keys Right
wait_for "│>    fog        fog"
expect "     density    0.14 "
expect "▏fog colour #ffffff"
expect "     falloff    5 "
keys u
wait_for "│>    fog        off"
wait_until_gone "falloff"
keys Down
raw_keys '.5'
keys Enter
wait_for "│>    density    0.5 "
keys Down
wait_for "│>    scatters   0.5 0.5 0.5"
raw_keys '.2 .3 .4'
keys Enter
wait_for "│>    scatters   0.2 0.3 0.4"
keys C-s
wait_for "wrote lamp.view"
cat >expected.view <<'END'
eye 0 0 5
at 0 0 0
res 100 50
background 0 0 0
fog scatter 0.2 0.3 0.4 absorb 0 0 0 anisotropy 0
END
cmp expected.view lamp.view || die "lamp.view: $(cat lamp.view)"
# without density the fog is gone, also from the file
keys Up
wait_for "│>    density"
keys 0 Enter
wait_for "│     fog        off"
keys C-s
wait_until eval "sed 4q expected.view | cmp -s - lamp.view"
keys C-q
expect_end 0
