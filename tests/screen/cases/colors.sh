# SPDX-License-Identifier: MIT
# The palettes by option, by key and by the environment.
flat_scene
has()
{
    wait_until eval "screen_colors | grep -q '$1'"
}
size=100x21
start --color 256 flat.obj
has '48;5;13[0-9]m\|48;5;172m\|48;5;136m'
keys g
wait_for "256 colours"
keys g
keys C
wait_for "16 colours"
has '\[4[0-9]m'
keys C
wait_for "mono"
wait_for "⠅⠅⠅" # light of a quarter: two dots of eight
keys C
has '48;2;188;124;0m'
keys C-q
expect_end 0
# Some of these have no second screen to come back from: it is cleared.
for case in "GLIM_COLOR=256:256 colours" "NO_COLOR=1:mono" \
    "NO_COLOR= COLORTERM=truecolor:24 bit" "NO_COLOR=1 GLIM_COLOR=16:16 colours" \
    "TERM=screen TMUX= STY=1.x:256 colours" "TERM=linux TMUX=:16 colours" \
    "TERM=vt100 TMUX=:mono" "TERM=xterm-nonsense TMUX=:256 colours" \
    "TERM=xterm TMUX= COLORTERM=truecolor:24 bit"; do
    fresh
    start_line "export TERM=tmux-256color; env ${case%:*} glim flat.obj"
    wait_for "LIVE "
    keys g
    wait_for "  ${case#*:} *│"
    keys C-q
    expect_end 0 cleared
    reject "LIVE"
    reject "▀▀▀"
done
# What is asked for wins over NO_COLOR.
fresh
start_line "TERM=tmux-256color NO_COLOR=1 glim --color=24bit flat.obj"
wait_for "LIVE "
keys g
wait_for "  24 bit *│"
keys C-q
expect_end 0
fresh
start_line "TERM=tmux-256color GLIM_COLOR=red glim flat.obj"
wait_for "^glim: GLIM_COLOR: found 'red', expected 24, 256, 16, mono or"
expect_end 2
