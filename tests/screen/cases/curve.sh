# SPDX-License-Identifier: MIT
# A diagram of characters is no larger than the window.
size=40x12
glim reference -s 64 -w 16 -h 16 reference.pfm "$root/scenes/cornell.obj" \
    >/dev/null 2>&1
start_line "glim curve -s 8 reference.pfm '$root/scenes/cornell.obj'"
wait_for "^exit 0"
expect "^relative MSE over seconds$"
expect "^       +-------------------------------$"
