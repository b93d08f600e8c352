# SPDX-License-Identifier: MIT
# Without an argument glim lists the scenes that were opened last.
flat_scene
lamp_scene
start_line "TERM=tmux-256color glim"
wait_for "^exit 2" # there are none yet
expect "found no scene"
for scene in flat lamp; do
    fresh
    start $scene.obj
    wait_for "LIVE .* spp"
    keys C-q
    expect_end 0
done
fresh
size=120x21
start_line "cd / && TERM=tmux-256color glim; status=\$?; cd - >/dev/null; (exit \$status)"
# The question is the last line; a key before it would be echoed between the lines.
wait_for "^number or file of a scene"
expect "^  1  .*/lamp.obj"
expect "^  2  .*/flat.obj"
keys 7 Enter
wait_for "7: no such scene"
keys 2 Enter
wait_for "LIVE .* spp"
wait_for_rows 20 "48;2;188;124;0"
keys C-q
expect_end 0
fresh
start_line "TERM=tmux-256color glim"
wait_for "^number or file of a scene"
expect "^  1  .*/flat.obj" # it was opened last
keys q Enter
expect_end 0
# With options, but no scene, it is the same; they count.
fresh
start_line "TERM=tmux-256color glim --color mono -t 1"
wait_for "^number or file of a scene"
expect "^  1  .*/flat.obj"
keys Enter
wait_for "LIVE .* mono "
keys C-q
expect_end 0
# What is wrong with them is said before anybody has to choose.
fresh
start_line "TERM=tmux-256color glim --device x --backend cpu"
wait_for "^glim: --device: found --backend cpu"
expect_end 2
