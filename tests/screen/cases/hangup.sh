# SPDX-License-Identifier: MIT
# The line is lost: the program ends by itself and keeps the picture, beside the
# scene or in the state folder. So does SIGTERM with what q would ask about.
XDG_STATE_HOME=$PWD/state
export XDG_STATE_HOME
gone()
{
    ! kill -0 "$pid" 2>/dev/null
}
# Every pixel is the background, with any number of samples: the same file.
is_whole()
{
    cmp "$1" reference.png || die "$1 is not the picture"
}
mkdir scenes
flat_scene
glim -b -s 1 -o reference.png flat.obj 2>/dev/null
mv flat.obj flat.view scenes
start scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
pid=$(program_pid)
mux kill-session
wait_until gone
is_whole scenes/flat-kept.png
[ ! -e state/glim/flat-kept.png ] || die "more than one picture was kept"
[ -z "$(find . -name '.glim-*')" ] || die "left: $(find . -name '.glim-*')"

# again, with signals that go on while it is saved: nothing is replaced
start -w 900 -h 600 scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
pid=$(program_pid)
for i in 1 2 3 4 5 6 7 8 9; do
    kill -HUP "$pid" 2>/dev/null || break
    sleep 0.01
done
expect_end 129
expect "^kept scenes/flat-kept-2.png, [1-9][0-9]* spp"
[ -s scenes/flat-kept-2.png ]

# nothing can be written anywhere: it ends all the same
fresh
start_line "(ulimit -f 0; trap '' XFSZ; TERM=tmux-256color exec glim scenes/flat.obj)"
wait_for "LIVE .* [1-9][0-9]* spp"
kill -HUP "$(program_pid)"
expect_end 129
expect "flat-kept.png: File to"
[ ! -e state/glim/flat-kept.png ] || die "written despite the limit"

# SIGTERM asks nobody: only a render that would be lost is kept
fresh
start scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
kill -TERM "$(program_pid)"
expect_end 143
[ ! -e scenes/flat-kept-3.png ] || die "a live picture was kept"
fresh
start -s 1000000000 scenes/flat.obj
wait_for "LIVE"
keys Space Enter
wait_for "NORMAL  [1-9][0-9]*/1000000000 spp"
kill -TERM "$(program_pid)"
expect_end 143
expect "^kept scenes/flat-kept-3.png"

[ "$(id -u)" != 0 ] || exit 0 # may write everywhere
fresh
chmod a-w scenes
start scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
kill -HUP "$(program_pid)"
expect_end 129
chmod u+w scenes
is_whole state/glim/flat-kept.png
