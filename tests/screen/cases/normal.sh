# SPDX-License-Identifier: MIT
# Normal mode starts, halts, continues and ends, and asks before a picture is
# lost. The program sleeps when nothing changes.
lamp_scene
size=100x21
start -s 5 lamp.obj
wait_for LIVE
keys Space
wait_for "normal mode: Enter starts the render"
keys w
wait_for "the camera moves only in live mode"
wait_for "NORMAL ready"
keys C-q # nothing was rendered: no question
expect_end 0
fresh
start -s 5 lamp.obj
wait_for LIVE
keys Space Enter
wait_for "NORMAL done  5/5 spp  100 %"
wait_until rests
keys Enter
wait_for "the render is done"
keys C-q
wait_for "Unsaved render. Quit?"
keys n
wait_for "NORMAL done"
keys Space
wait_for "Unsaved render. Leave it?"
keys n
wait_for "NORMAL done"
keys p
wait_for "saved lamp.png 100x50, 5 spp"
keys C-q
expect_end 0
expect "^saved lamp.png 100x50, 5 spp"
[ "$(head -c 8 lamp.png | od -An -c | tr -d ' ')" = '211PNG\r\n032\n' ] ||
    die "lamp.png is no PNG"
fresh
start -s 1000000000 lamp.obj
wait_for LIVE
keys Space Enter
wait_for "NORMAL  [1-9][0-9]*/1000000000 spp"
keys Enter
wait_for "NORMAL paused"
wait_until rests # a halted render does not go on
expect "NORMAL paused"
keys Enter
wait_for "NORMAL  [1-9]"
keys C-q
wait_for "Unsaved render. Quit?"
keys y
expect_end 0

# the error ends it, and is in the statistics
fresh
start -e 20% --stats run.json lamp.obj
wait_for LIVE
keys Space Enter
wait_for "NORMAL done  [0-9]* spp  100 %  noise [0-9]"
keys C-q y
expect_end 0
grep -q '"stopped_by": "error",' run.json || die "not stopped by the error"
# a pause is not time of rendering
fresh
start -e 0.0001% --time 2 --stats run.json lamp.obj
wait_for LIVE
begin_ns=$(date +%s%N)
keys Space Enter
wait_for "NORMAL  .* left [12] s"
keys Enter
wait_for "NORMAL paused"
sleep 2.1
keys Enter
wait_for "NORMAL  .* left [12] s"
wait_for "NORMAL done"
without_pause_ms=$((($(date +%s%N) - begin_ns) / 1000000 - 2100))
keys C-q y
expect_end 0
grep -q '"stopped_by": "time",' run.json || die "not stopped by the time"
awk -F'[:,]' -v most_ms=$without_pause_ms \
    '/"render_s"/ { exit !($2 >= 1.9 && 1000 * $2 <= most_ms) }' run.json ||
    die "another time: $(grep render_s run.json), at most $without_pause_ms ms"
