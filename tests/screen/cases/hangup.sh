# SPDX-License-Identifier: MIT
# When the terminal is lost, the program ends and saves a picture of some work
# to one file in the state folder; the next start tells of it. SIGTERM saves if
# q would ask.
size=80x22
XDG_STATE_HOME=$PWD/state
export XDG_STATE_HOME
lost=state/glim/lost.png
gone()
{
    ! kill -0 "$pid" 2>/dev/null
}
# Prints a PNG file from its pixels on, without the texts before them, which
# tell the number of samples.
pixels()
{
    tail -c "+$(LC_ALL=C grep -a -b -o IDAT "$1" | sed -n '1s/:.*//p')" "$1"
}
# Every pixel is the background, with any number of samples.
is_whole()
{
    pixels "$1" | cmp - reference.pixels || die "$1 is not the picture"
}
# Nothing but the scene lies beside it, and nothing but one picture there.
is_tidy()
{
    [ "$(ls -A scenes)" = "$(printf 'flat.obj\nflat.view')" ] ||
        die "beside the scene: $(ls -A scenes)"
    [ "$(ls -A state/glim | grep -v '^lost.png$')" = recent ] ||
        die "in the state folder: $(ls -A state/glim)"
}
worth="LIVE .* \([5-9]\|[1-9][0-9]\) s "
mkdir scenes
flat_scene
glim -b -s 1 -o reference.png flat.obj 2>/dev/null
pixels reference.png >reference.pixels
mv flat.obj flat.view scenes

# a picture of a moment is nothing to keep
start scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
kill -HUP "$(program_pid)"
expect_end 129
[ ! -e $lost ] || die "the picture of a moment was kept"
fresh

start scenes/flat.obj
wait_for "$worth"
pid=$(program_pid)
mux kill-session
wait_until gone
is_whole $lost
is_tidy

# told once, and with signals that go on while it is saved: it is replaced
start -w 900 -h 600 scenes/flat.obj
wait_for "^ picture of the lost session: /"
keys Escape
wait_for "$worth"
pid=$(program_pid)
while kill -HUP "$pid" 2>/dev/null; do
    :
done
expect_end 129
expect "^picture of the lost session: /"
expect "^kept .*"
! pixels $lost | cmp -s - reference.pixels || die "the picture before was not replaced"
is_tidy

# nothing can be written: it ends all the same, and the picture before stays
fresh
cp $lost before.png
start_line "(ulimit -f 0; trap '' XFSZ; TERM=tmux-256color exec glim scenes/flat.obj)"
wait_for "^ picture of the lost session: /"
keys Escape
wait_for "$worth"
kill -HUP "$(program_pid)"
expect_end 129
expect "lost.png: File to"
cmp $lost before.png || die "written despite the limit"
is_tidy

# SIGTERM asks nobody: only a render that would be lost is kept
fresh
start scenes/flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
keys Escape
wait_for "$worth"
kill -TERM "$(program_pid)"
expect_end 143
cmp $lost before.png || die "a live picture was kept"
fresh
start -s 1000000000 scenes/flat.obj
wait_for "LIVE"
reject "lost session" # it was told of
keys Space Enter
wait_for "NORMAL  [1-9][0-9]*/1000000000 spp"
kill -TERM "$(program_pid)"
expect_end 143
expect "^kept "
is_whole $lost
is_tidy

[ "$(id -u)" != 0 ] || exit 0 # may write everywhere
fresh
chmod a-w state/glim
start scenes/flat.obj
wait_for "LIVE"
keys Escape
wait_for "$worth"
kill -HUP "$(program_pid)"
expect_end 129
expect "lost.png: \|glim: Permission"
chmod u+w state/glim
is_tidy
