# SPDX-License-Identifier: MIT
# Without a scene glim shows a list of scenes: those opened last, a folder to
# browse, those of glim. O opens another scene from a running program.
flat_scene
lamp_scene
size=120x30
mkdir sub
cp flat.* sub/
printf 'no mesh' >sub/broken.glb
shows_flat()
{
    [ "$(rows_with "48;2;188;124;0")" -ge 20 ]
}
begin() # the program without a scene, with options
{
    start_line "TERM=tmux-256color glim $*"
    wait_for "─ open a scene ─"
}
begin
reject "Opened last"
expect "folder  *sub/"
expect "obj  *flat.obj"
expect "obj  *lamp.obj"
expect "Of glim"
expect "cornell.obj"
raw_keys "amp"
wait_for ": amp_  *[1-9] of [1-9]"
reject "flat.obj"
keys Enter
wait_for "LIVE .* spp"
# another one from there, whose folder is entered
keys O
wait_for "Opened last"
expect "lamp.obj"
raw_keys "sub"
wait_for "sub/"
keys Enter
wait_for ": _  *3"
expect "broken.glb"
keys Down Down Enter
wait_until shows_flat
wait_for "LIVE .* spp"
# back without a choice
keys O
wait_for "Opened last"
expect "sub/flat.obj"
keys Escape
wait_until_gone "Opened last"
wait_for "LIVE .* spp"
# and out of the list
keys O
wait_for "Opened last"
keys C-q
expect_end 0
# one that cannot be read says why, and the list comes back
fresh
begin
wait_for "Opened last"
raw_keys "sub/"
keys Down
wait_for "sub/"
keys End Enter
wait_for "broken.glb"
raw_keys "brok"
wait_for ": brok_"
keys Enter
wait_for "broken.glb: found no glTF"
expect "─ open a scene ─"
keys Escape
expect_end 0
# With options, but no scene, it is the same; they count.
fresh
begin --color mono -t 1
wait_for "Opened last"
raw_keys "lamp"
wait_for ": lamp_"
keys Enter
wait_for "LIVE"
keys g
wait_for "mono *│"
expect "1 thread "
keys C-q
expect_end 0
# unsaved changes are asked for
fresh
start lamp.obj
wait_for "LIVE .* spp"
keys Tab Enter
wait_for "│>    type"
keys Down Down Down Right Right Right
keys Escape Escape
wait_until_gone "Materials"
keys Escape # the menu says where they would be written
wait_for "save 1 material to lamp.mtl"
keys C-q # a question closes the menu
wait_for "Unsaved changes. Quit?"
reject "save 1 material"
keys n
wait_until_gone "Quit?"
leave_for() # chooses another scene
{
    keys O
    wait_for "Opened last"
    raw_keys "$1"
    wait_for ": $1_"
    keys Enter
}
leave_for flat
wait_for "Unsaved changes. Leave? y: yes, s: save, other: no"
keys n
wait_until_gone "Leave?"
reject "Opened last"
leave_for flat
wait_for "Leave?"
keys y
wait_until shows_flat
keys C-q
expect_end 0
# too small, and the right size again
fresh
begin
mux resize-window -x 30 -y 10
wait_for "has 30x10"
mux resize-window -x 80 -y 24
wait_for "─ open a scene ─"
keys C-c
expect_end 0
# What is wrong with options is said before anybody has to choose.
fresh
start_line "TERM=tmux-256color glim --device x --backend cpu"
wait_for "^glim: --device: found --backend cpu"
expect_end 2
