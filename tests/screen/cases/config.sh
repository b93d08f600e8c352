# SPDX-License-Identifier: MIT
# Keys and options from the configuration file.
flat_scene
size=80x24
mkdir glim
printf 'key quit x\nkey help F1 y\noption color 16\noption glyph ascii\n' \
    >glim/config
start_line "TERM=tmux-256color XDG_CONFIG_HOME=$PWD glim flat.obj"
wait_for "LIVE.*F1 help"
reject "▀"
keys '?' # does nothing now
keys y
wait_for "Esc back"
raw_keys 'commands'
wait_for "F1 y *all commands and keys"
keys Escape End
wait_for "x *quit"
keys Escape
wait_until_gone "Esc back"
keys C-q # no more
keys C
wait_for "  mono" # what is next after 16
keys x
expect_end 0
fresh
# the command line and the environment override it
start_line "TERM=tmux-256color XDG_CONFIG_HOME=$PWD glim --color 256 flat.obj"
wait_for "LIVE"
keys C
wait_for "  16 col" # what is next after 256
keys x
expect_end 0
fresh
start_line \
    "TERM=tmux-256color GLIM_COLOR=mono XDG_CONFIG_HOME=$PWD glim flat.obj"
wait_for "LIVE"
keys C
wait_for "LIVE  24 bit"
keys x
expect_end 0
fresh
printf 'key quit\n' >glim/config
start_line "TERM=tmux-256color XDG_CONFIG_HOME=$PWD glim flat.obj"
wait_for "config:1: found the end"
expect_end 2
