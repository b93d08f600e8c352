# SPDX-License-Identifier: MIT
# In the shipped room the camera stands with its back at a wall. A tap stays in
# the room; a message tells when the camera goes through the wall, and how to
# return.
cp "$root"/scenes/interior.* "$root"/scenes/*.png .
eye_z() # of the view that is written now; c ends a move
{
    rm -f interior.view
    keys c
    wait_until test -s interior.view
    awk '$1 == "eye" { print $4 }' interior.view
}
start interior.obj
wait_for "LIVE .* spp"
keys s
z=$(eye_z)
awk "BEGIN { exit !($z > 5.71 && $z < 5.9) }" ||
    die "a tap from 5.7 came to $z, expected a small step before the wall at 6"
reject "outside"
tries=0
until screen | grep -q "  outside the scene, behind a wall: r returns"; do
    tries=$((tries + 1))
    [ $tries -lt 300 ] || die "never told that the wall was passed"
    keys s
done
keys r
wait_for "  the view as it was opened"
z=$(eye_z)
[ "$z" = 5.7 ] || die "r came to $z, expected 5.7"
keys q
expect_end 0
