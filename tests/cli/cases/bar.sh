# SPDX-License-Identifier: MIT
# The progress bar is one line on a terminal, is rewritten, and is removed.
command -v script >/dev/null || skip "no script(1) to make a terminal"
take box
glim -b -w 40 -h 30 -s 1 -o quiet.png box.obj 2>err
wc -l <err | tr -d ' '
script -q -c 'stty cols 60; timeout --foreground -s INT 1.5 \
    glim -b -w 40 -h 30 -s 1000000000 -o out.png box.obj' log >/dev/null 2>&1
tr '\r' '\n' <log | grep -c '^ *0 % \[-*\] [0-9]* of' |
    awk '{ print ($1 >= 3 && $1 <= 16 ? "some bars" : $1 " bars") }'
tr '\r' '\n' <log | grep spp | awk 'length > 59 && !/stopped/ { print "too wide: " $0 }'
grep 'stopped by' log | tr '\r' '\n' | grep 'stopped' |
    sed 's/ at [0-9]* of/ at N of/' | untimed
# the noise, and the time left of the nearest limit
script -q -c 'stty cols 100; glim -b -w 40 -h 30 --time 1.5 -e 1e-9% \
    -s 1000000000 -o out.png box.obj' log >/dev/null 2>&1
bar='^ *[0-9]* % \[#*-*\] [0-9]* of 1000000000 spp, [0-9.]* Msamples/s, 0:0[01]'
tr '\r' '\n' <log | grep -c "$bar, left 0:0[012], noise [0-9.]* %\$" |
    awk '{ print ($1 >= 2 ? "noise and time left" : $1 " bars") }'
