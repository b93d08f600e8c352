# SPDX-License-Identifier: MIT
# Every exit restores the terminal and has its exit status.
flat_scene
first=yes
for case in TERM:143 HUP:129 INT:130 QUIT:131 SEGV:139 ABRT:134; do
    [ $first = yes ] || fresh
    first=no
    start_line "ulimit -c 0; ASAN_OPTIONS=handle_segv=0:handle_abort=0 \
TSAN_OPTIONS=handle_segv=0:handle_abort=0 TERM=tmux-256color glim flat.obj"
    wait_for "LIVE .* spp"
    kill -"${case%:*}" "$(program_pid)"
    expect_end "${case#*:}"
done
for case in C-c:0 'C-\:131' C-q:0; do
    fresh
    start flat.obj
    wait_for "LIVE .* spp"
    keys "${case%:*}"
    expect_end "${case#*:}"
done
