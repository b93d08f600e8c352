# SPDX-License-Identifier: MIT
# Light that does not fit the sums of pixels is cut, with a message on the screen
# and at the end.
flat_scene
sed -i 's/^background.*/background 1e20 1e20 1e20/' flat.view
size=130x21
start flat.obj
wait_for 'samples were too bright: sums above 2^63 are cut'
keys C-q
expect_end 0
expect '^[0-9]* samples were too bright'
