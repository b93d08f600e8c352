# SPDX-License-Identifier: MIT
# When the terminal is lost, the session is kept in the state folder, and the
# next start of the scene goes on with view, changes and film. A program that is
# killed has written it before. Quitting removes it.
size=140x24
XDG_STATE_HOME=$PWD/state
export XDG_STATE_HOME
gone()
{
    ! kill -0 "$pid" 2>/dev/null
}
kept()
{
    find state/glim/sessions -name '*.session'
}
is_kept_twice()
{
    [ "$(kept | wc -l)" = 2 ]
}
is_kept()
{
    [ -n "$(kept)" ]
}
# Prints the samples per pixel on the status line.
spp()
{
    screen | sed -n 's/^ *LIVE .* \([0-9][0-9]*\) spp.*/\1/p' | head -n 1
}
has_spp()
{
    [ -n "$(spp)" ]
}
# Nothing is left beside the scene, and so many sessions in the folder, which
# also has the last pictures of scenes.
is_tidy()
{
    [ "$(ls -A scenes)" = "$(printf 'lamp.mtl\nlamp.obj\nlamp.view')" ] ||
        die "beside the scene: $(ls -A scenes)"
    [ "$(ls -A state/glim)" = "$(printf 'recent\nsessions')" ] ||
        die "in the state folder: $(ls -A state/glim)"
    [ "$(ls -A state/glim/sessions | grep -v '^lock$\|\.png$' | wc -l)" = "$1" ] ||
        die "sessions: $(ls -A state/glim/sessions)"
}
shows() # a colour of the picture, as R;G;B
{
    wait_until eval "screen_colors | sed 's,│.*,,' | grep -q '[34]8;2;$1m'"
}
worth="LIVE .*  \([5-9]\|[1-9][0-9]\) s  "
asks=" kept: [1-9][0-9]* s of render; ^R goes on"
mkdir scenes
lamp_scene
mv lamp.* scenes

# a picture of a moment is nothing to keep
start scenes/lamp.obj
wait_for "LIVE .* [1-9][0-9]* spp"
kill -HUP "$(program_pid)"
expect_end 129
is_tidy 0
fresh

# the terminal is lost: the film goes on
start scenes/lamp.obj
wait_for "$worth"
pid=$(program_pid)
before=$(spp)
mux kill-session
wait_until gone
is_tidy 1
start scenes/lamp.obj
wait_for "$asks"
keys C-r
wait_for "restored: view, changes, render"
keys Escape
wait_until_gone "restored"
wait_until has_spp
[ "$(spp)" -ge "$before" ] || die "$(spp) spp, but $before were kept"

# signals that go on while it is kept; another program leaves it alone
second=$(glim --sessions)
case $second in
"$PWD/scenes/lamp.obj: "*" s of render, "*" ago, "*" MB") ;;
*) die "listed: $second" ;;
esac
pid=$(program_pid)
while kill -HUP "$pid" 2>/dev/null; do
    :
done
expect_end 129
expect "^kept .* s of render: glim scenes/lamp.obj goes on"
is_tidy 1
fresh

# it is offered until it is taken or dropped, whatever keys are pressed
for key in C-q C-c; do
    start scenes/lamp.obj
    wait_for "$asks"
    keys w r
    wait_for "kept session: ^R"
    keys $key
    wait_for "^exit "
    is_tidy 1
    fresh
done

# another picture: the film is not taken, and it is said what differs
start --seed 7 scenes/lamp.obj
wait_for "$asks"
keys C-r
wait_for "seed"
keys Escape
keys C-q
expect_end 0
is_tidy 0
fresh

# a changed material, killed: no signal is seen, but it was written at once
start scenes/lamp.obj
shows '255;255;255'
keys Tab
wait_for "│ Materials  Objects  Light "
keys Enter
keys Down Down Down Down Down Down Down Down Down Down Down
wait_for "│>....of colour  #ffffff"
raw_keys '#ff0000'
keys Enter
shows '255;0;0'
wait_until is_kept
kill -KILL "$(program_pid)"
wait_for " exit 137"
fresh
start scenes/lamp.obj
wait_for "kept: \(unsaved changes\|.* s of render and unsaved changes\); ^R goes on"
shows '255;255;255'
# changes of this session do not replace it: both are kept
keys Tab Enter
keys Down Down Down Down Down Down Down Down Down Down Down
raw_keys '#00ff00'
keys Enter
shows '0;255;0'
wait_until is_kept_twice
kill -KILL "$(program_pid)"
wait_for " exit 137"
fresh
start scenes/lamp.obj
wait_for "kept: .*unsaved changes; ^R goes on"
keys C-r
wait_for "restored: view\|kept: "
shows '0;255;0'
wait_for "kept session: ^R"
keys C-r
wait_for "Unsaved changes. Replace them?"
keys y
wait_for "restored: view"
shows '255;0;0'
keys Tab
wait_for " l \*"
keys u
shows '255;255;255'
keys U
shows '255;0;0'

# SIGTERM asks nobody either
kill -TERM "$(program_pid)"
expect_end 143
expect "^kept .*unsaved changes: glim"
is_tidy 1
fresh

# nor does the key that ends the program at once
start scenes/lamp.obj
wait_for "kept: .*unsaved changes"
keys C-r
wait_for "restored"
raw_keys "$(printf '\034')"
expect_end 131
expect "^kept .*unsaved changes: glim"
is_tidy 1
fresh

# nothing can be written: it ends all the same, and the file before stays
file=$(kept)
cp "$file" earlier.session
start_line "(ulimit -f 0; trap '' XFSZ; TERM=tmux-256color exec glim scenes/lamp.obj)"
wait_for "kept: .*unsaved changes"
keys C-r
wait_for "restored\|File too large"
shows '255;0;0'
keys w
kill -HUP "$(program_pid)"
expect_end 129
expect "session: File to"
cmp "$file" earlier.session || die "written despite the limit"
is_tidy 1
fresh

# it is dropped
start scenes/lamp.obj
wait_for "kept: .*unsaved changes"
raw_keys ':drop'
wait_for "drop the kept session"
keys Enter
wait_for "the kept session is dropped"
is_tidy 0
shows '255;255;255'
keys C-q
expect_end 0
is_tidy 0
fresh

# a picture of normal mode goes on in that mode
start -s 1000000000 scenes/lamp.obj
wait_for "LIVE"
keys Space Enter
wait_for "NORMAL .*  \([5-9]\|[1-9][0-9]\) s  "
kill -TERM "$(program_pid)"
expect_end 143
fresh
start -s 1000000000 scenes/lamp.obj
wait_for "$asks"
keys C-r
wait_for "restored"
keys Escape
wait_for "NORMAL  [1-9][0-9][0-9][0-9]*/1000000000 spp"
keys C-q
wait_for "Unsaved render. Quit?"
keys y
expect_end 0
is_tidy 0
fresh

# a damaged file is said in one line, and a session starts anew
for text in 'glim session 1' 'something else' ''; do
    echo "$text" >"state/glim/sessions/$(basename "$file")"
    start scenes/lamp.obj
    wait_for "session.* expected"
    keys C-q
    expect_end 0
    is_tidy 0
    fresh
done
