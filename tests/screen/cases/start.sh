# SPDX-License-Identifier: MIT
# Errors before the screen opens; keys that come too early; notes.
flat_scene
start nosuch.obj
wait_for "^glim: nosuch.obj: "
expect_end 1
fresh
start_line "TERM=dumb glim flat.obj"
wait_for "^glim: TERM=dumb: found a terminal that cannot show a picture"
expect_end 1
fresh
start_line "TERM=tmux-256color glim flat.obj </dev/null"
wait_for "^glim: standard input: found no terminal"
expect_end 2
fresh
start_line "until [ -e go ]; do sleep 0.05; done; TERM=tmux-256color glim -b -w 2 -h 2 -s 1 -o x.png flat.obj
TERM=tmux-256color glim flat.obj"
keys c # before the program
: >go
wait_for "Change flat.view?"
keys n
keys C-q
expect_end 0
fresh
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >dark.obj
start dark.obj
wait_for "no light in the scene: lit by a soft sky"
keys C-q
expect_end 0
# who waits for a scene is told so, and can end it
mkfifo slow.obj
read_slowly="glim -b -s 1 -w 2 -h 2 -o x.png - <slow.obj"
fresh
start_line "trap : INT; $read_slowly"
sleep 100 >slow.obj &
wait_for "^reading standard input, 0.0 MB, [1-9] s (Ctrl-C ends)"
keys C-c
wait_for "exit 130"
kill $!
fresh
start_line "$read_slowly"
{
    cat flat.obj
    wait_for "^reading standard input, 0.0 MB, [1-9] s (Ctrl-C ends)"
} >slow.obj
expect_end 0
reject "reading"
