# SPDX-License-Identifier: MIT
# Ctrl-Z gives the terminal to the shell, fg brings the picture back.
flat_scene
start_line "PS1='ready> ' TERM=tmux-256color bash --norc -i"
wait_for "ready>"
keys "glim flat.obj" Enter
wait_for_rows 15 "48;2;188;124;0"
for way in key signal; do
    if [ $way = key ]; then
        keys C-z
    else
        pkill -TSTP -P "$(pgrep -P "$(mux display-message -p '#{pane_pid}')" bash)" glim
    fi
    wait_for "Stopped"
    [ "$(mux display-message -p '#{alternate_on}#{mouse_any_flag}')" = 00 ] ||
        die "modes are on while stopped"
    keys clear Enter
    wait_until_gone "Stopped"
    keys "echo he''re; fg" Enter
    wait_for "LIVE"
    wait_for_rows 15 "48;2;188;124;0"
    reject "here"
done
# what was typed behind it is not for glim
raw_keys "$(printf '\032q')"
wait_for "Stopped"
keys fg Enter
wait_for "LIVE"
keys C-q
wait_for "glim flat.obj"
keys exit Enter
expect_end 0 cleared
