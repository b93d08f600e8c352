# SPDX-License-Identifier: MIT
# p never replaces a file and shows the name; an error stays until a key.
flat_scene
mkdir sub
mv flat.obj flat.view sub
start -w 50 sub/flat.obj # for this run: the file keeps its size
wait_for "LIVE .* [1-9][0-9]* spp"
keys p
wait_for "saved flat.png 50x25, [1-9][0-9]* spp"
keys p
wait_for "saved flat-2.png 50x25"
keys P
wait_for "saved flat.hdr 50x25, [1-9][0-9]* spp"
keys Escape :
wait_for "Esc back"
raw_keys "exr"
wait_for "save a linear EXR file"
keys Enter
wait_for "saved flat.exr 50x25, [1-9][0-9]* spp"
printf 'v/1\001' | cmp -n 4 - flat.exr || die "flat.exr is no EXR picture"
head -n 1 flat.hdr | grep -q '^#?RADIANCE' || die "flat.hdr is no HDR picture"
keys Escape
mv sub away
touch sub
keys i
keys c # an error is seen without the status line, too, and until a key
wait_for "sub/flat.view"
rm sub
mv away sub
says_what_it_saves() # again if the machine stood still while it was said
{
    keys p
    for _ in $(seq 60); do
        ! has_line "saved flat-[0-9]*.png" || return 0
        sleep 0.05
    done
    return 1
}
wait_until says_what_it_saves
[ -s flat-3.png ] || die "flat-3.png: found none or an empty one: $(ls -l)"
keys Escape
wait_until_gone "saved"
keys i
wait_for "LIVE"
cp sub/flat.view mine.view
keys k 1
wait_for "stored as view 1"
keys c
wait_for "wrote the view to sub/flat.view, the old one is"
cmp sub/flat.view~ mine.view || die "the view before is lost"
keys C-q
expect_end 0
expect "^saved flat.png"
expect "^saved flat-2.png"
expect "^wrote the view to sub/flat.view"
grep -q '^eye 0 0 5' sub/flat.view || die "$(cat sub/flat.view)"
grep -q '^res 100 50' sub/flat.view || die "$(cat sub/flat.view)"
[ -s flat.png ] && [ -s flat-2.png ] && [ -s flat-3.png ] ||
    die "pictures: found not all three: $(ls -l)"
[ "$(id -u)" != 0 ] || exit 0 # may write everywhere
fresh
mkdir readonly
chmod a-w readonly
start_line "cd readonly && TERM=tmux-256color glim ../sub/flat.obj; cd .."
wait_for "LIVE .* [1-9][0-9]* spp"
keys Enter
wait_for "LIVE paused"
keys p
wait_for "flat.png: "
wait_until rests
expect "flat.png: "
keys '~'
wait_for "LIVE"
keys C-q
expect_end 0
