# SPDX-License-Identifier: MIT
# Values of the view as options begin the view on the screen, r returns to them,
# and only c writes them.
flat_scene
cp flat.view mine.view
start --eye 0.25,0,3 --at 0,0,0 --fov 30 --exposure 1 flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
keys d
keys r
keys C-q
expect_end 0
cmp flat.view mine.view || die "the view was written without c"
fresh
start --eye 0.25,0,3 --at 0,0,0 --fov 30 --exposure 1 flat.obj
wait_for "LIVE .* [1-9][0-9]* spp"
keys d
keys r
keys c
wait_for "Change flat.view?"
keys y
wait_for "wrote the view to flat.view"
keys C-q
expect_end 0
for line in 'eye 0.25 0 3' 'at 0 0 0' 'fovy 30' 'exposure 1'; do
    grep -qx "$line" flat.view || die "no $line: $(cat flat.view)"
done
