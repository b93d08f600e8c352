# SPDX-License-Identifier: MIT
# Pasted text is no command: outside of text fields it is dropped, with a word.
# The key that writes the view asks before it changes a file.
lamp_scene
size=80x24
start lamp.obj
wait_for "LIVE .* spp"
mux set-buffer 'wasdqecp:quit
'
mux paste-buffer -p
wait_for "pasted text is dropped"
[ "$(ls -A)" = "$(printf 'before\nlamp.mtl\nlamp.obj\nlamp.view\nline.sh')" ] ||
    die "files: $(ls -A)"
cp lamp.view lamp.view.first
# the list of commands takes it, but no line end runs one
keys ':'
wait_for "move forward"
mux set-buffer 'quit
'
mux paste-buffer -p
wait_for ": quit_"
keys Escape Escape
wait_until_gone "quit_"
# a value takes it
keys Tab Enter Down Down Down Down Down Down Down Down Down Down Down
wait_for "│>....of colour"
mux set-buffer '#ff0000'
mux paste-buffer -p
wait_for "of colour  #ff0000_"
keys Enter
wait_for "of colour  #ff0000 *│*$"
keys Escape Escape
wait_until_gone "│"
# the view file
keys w c
wait_for "Change lamp.view?"
keys n
wait_until_gone "Change lamp.view?"
cmp lamp.view lamp.view.first || die "written unasked"
keys c
wait_for "Change lamp.view?"
keys y
wait_for "wrote the view to lamp.view"
cmp -s lamp.view lamp.view.first && die "not written"
keys s c
wait_for "wrote the view to lamp.view"
keys C-q
wait_for "Unsaved changes. Quit?"
keys y
expect_end 0
# A paste whose end is lost is over two seconds after its last character, though
# the terminal answers every frame meanwhile.
fresh
cp "$root"/scenes/cornell.* .
start cornell.obj
wait_for "LIVE .* spp"
raw_keys "$(printf '\033[200~lost')"
wait_for "pasted text is dropped"
sleep 2.5
keys C-q
expect_end 0
