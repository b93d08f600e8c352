# SPDX-License-Identifier: MIT
# Blocks, blanks, characters or dots, by option and by key.
lamp_scene
start lamp.obj
wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys G
wait_for "half blocks"
wait_for "[▀▄]"
reject "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys G
wait_for "braille"
wait_for "[⢀⡀⣀⣠⣄⠘⠉⣤⢠⡄⠙⠋⠛]"
reject "[▀▄]"
keys G
wait_for "letters"
wait_for "@@@"
keys G # this terminal has no pixels: round to the first
wait_for "blocks"
wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
reject "@@@"
keys C-q
expect_end 0
for case in "half:[▀▄]" "block:[▖▗▘▙▛▜▝▞▟▌▐▂▆]" "ascii:@@@" \
    "braille --color mono:⣿⣿" "block --color mono:@@@" \
    "block --color 16:[▖▗▘▙▛▜▝▞▟▌▐▂▆]" "half --color mono:@@@"; do
    fresh
    start "--glyph ${case%%:*}" lamp.obj
    wait_for "${case#*:}"
    keys C-q
    expect_end 0
done
# A message tells that requested pixels are not supported.
for case in "sixel:sixels" "kitty:kitty pixels"; do
    fresh
    start --glyph ${case%%:*} lamp.obj
    wait_for "blocks: the terminal reports no ${case#*:}"
    wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
    keys C-q
    expect_end 0
done
mkdir -p config/glim
echo 'option glyph sixel' >config/glim/config
fresh
start_line "XDG_CONFIG_HOME=\$PWD/config TERM=tmux-256color glim lamp.obj"
wait_for "blocks: the terminal reports no sixels"
keys C-q
expect_end 0
fresh
start --glyph sixel --color mono lamp.obj
wait_for "braille: sixels need colours"
keys C-q
expect_end 0
# Without colours dots come first, then letters.
fresh
start_line "TERM=tmux-256color glim --color mono lamp.obj"
wait_for "⣿⣿"
keys G
wait_for "letters"
keys C-q
expect_end 0
fresh
start --glyph ascii lamp.obj
wait_for "@@@"
reject "▀"
keys C-q
expect_end 0
rm "$XDG_STATE_HOME/glim/glyphs"
fresh
start_line "LC_ALL=C TERM=tmux-256color glim lamp.obj"
wait_until eval 'screen_colors | grep -q "48;2;255;255;255m"'
reject "[^ -~]"
keys G
wait_for "letters"
wait_for "@@@"
keys G
wait_for "blanks"
reject "@@@"
keys C-q
expect_end 0
rm -f "$XDG_STATE_HOME/glim/glyphs"
# G is remembered for this terminal, and Escape takes it back while the message
# is shown. An option and the configuration win.
fresh
lamp="TERM=tmux-256color glim lamp.obj"
start_line "$lamp"
wait_for "LIVE .* spp"
keys G
wait_for "half blocks from now on; Esc goes back"
wait_for "[▀▄]"
keys G
wait_for "braille from now on; Esc goes back"
keys Escape
wait_for "blocks again"
wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys G
wait_for "half blocks from now on"
keys C-q
expect_end 0
fresh
start_line "$lamp"
wait_for "LIVE .* spp"
wait_for "[▀▄]"
reject "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys C-q
expect_end 0
for case in "block:[▖▗▘▙▛▜▝▞▟▌▐▂▆]" "auto:[▖▗▘▙▛▜▝▞▟▌▐▂▆]" \
    "braille:[⢀⡀⣀⣠⣄⠘⠉⣤⢠⡄⠙⠋⠛]"; do
    fresh
    start --glyph ${case%%:*} lamp.obj
    wait_for "LIVE .* spp"
    wait_for "${case#*:}"
    keys C-q
    expect_end 0
done
echo 'option glyph block' >config/glim/config
fresh
start_line "XDG_CONFIG_HOME=\$PWD/config $lamp"
wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys C-q
expect_end 0
# Another terminal has its own.
fresh
start_line "TERM=screen-256color TMUX= glim lamp.obj"
wait_for "LIVE .* spp"
wait_for "[▖▗▘▙▛▜▝▞▟▌▐▂▆]"
keys C-q
expect_end 0
