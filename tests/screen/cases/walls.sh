# SPDX-License-Identifier: MIT
# In the shipped room the camera stands with its back at a wall, which stops it
# with a message. j lets it go through. Home returns, and a second time it shows
# the whole scene.
cp "$root"/scenes/interior.* "$root"/scenes/*.png .
eye_z() # of the view that is written now; c ends a move
{
    rm -f interior.view
    keys c
    wait_until test -s interior.view
    awk '$1 == "eye" { print $4 }' interior.view
}
press_s_until() # WORDS on the screen
{
    tries=0
    until screen | grep -q "$1"; do
        tries=$((tries + 1))
        [ $tries -lt 1500 ] || die "never saw $1: $(screen | tail -n 2)"
        keys s
    done
}
start interior.obj
wait_for "LIVE .* spp"
keys s
z=$(eye_z)
awk "BEGIN { exit !($z > 5.71 && $z < 5.9) }" ||
    die "a tap from 5.7 came to $z, expected a small step before the wall at 6"
reject "stops the camera"
press_s_until " stops the camera: j goes through"
z=$(eye_z)
awk "BEGIN { exit !($z > 5.9 && $z < 6) }" ||
    die "the wall at 6 stopped the camera at $z"
keys j
wait_for "the camera goes through walls"
wait_for "through walls"
tries=0
until awk "BEGIN { exit !($(eye_z) > 6.1) }"; do
    tries=$((tries + 1))
    [ $tries -lt 100 ] || die "never went through the wall"
    keys s s s
done
keys r
wait_for " the view as it was opened"
reject "through walls"
z=$(eye_z)
[ "$z" = 5.7 ] || die "r came to $z, expected 5.7"
keys r
wait_for "the whole scene"
keys C-q
expect_end 0
