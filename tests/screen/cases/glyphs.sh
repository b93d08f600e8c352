# SPDX-License-Identifier: MIT
# Half blocks, blanks or characters, as asked.
lamp_scene
start lamp.obj
wait_for "▀"
keys q
expect_end 0
fresh
start --glyph lower lamp.obj
wait_for "▄"
keys q
expect_end 0
fresh
start --glyph ascii lamp.obj
wait_for "@@@"
reject "▀"
keys q
expect_end 0
fresh
start_line "LC_ALL=C TERM=tmux-256color glim lamp.obj"
wait_until eval 'screen_colors | grep -q "48;2;255;255;255m"'
reject "[^ -~]"
keys q
expect_end 0
