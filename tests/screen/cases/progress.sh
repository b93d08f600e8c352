# SPDX-License-Identifier: MIT
# The window about the render: numbers as text, also where the window is small
# and there is no Unicode; the graph of the noise; the same as JSON at the end.
lamp_scene
size=80x24
start --stats run.json -s 40 -t 2 lamp.obj
wait_for "LIVE .* spp"
keys g
wait_for "┌─ about this render ─"
wait_for "CPU, 2 threads  *busy [0-9]* %"
wait_for "of rendering  *no limit"
keys Space Enter
wait_for "100x50 pixels  *40 of 40 spp"
wait_for "samples  *200 k .*samples/s"
wait_for "of rendering  *left 0 s"
# it is still there after the help and after another size, and at rest
keys '?'
wait_for "Esc back"
reject "about this render ─"
keys Escape
wait_for "┌─ about this render ─"
wait_for "40 of 40 spp"
mux resize-window -x 60 -y 20
wait_for "samples  *200 k .*/s"
wait_until rests
keys g
wait_until_gone "about this"
keys g
wait_for "about this"
keys i # nothing but the picture
wait_until_gone "about this"
reject "NORMAL"
keys i
wait_for "NORMAL done"
reject "about this"
keys C-q y
expect_end 0
for line in '"spp": 40,' '"samples": 200000,' '"percent": 100,' '"left_s": 0,' \
    '"stopped": false,'; do
    grep -q "^  $line" run.json || die "not in the object: $line"
done
# the spans have all samples, to the digits that are written
awk -F'[][,:]' '/"span_s"/ { span = $2 } /"render_s"/ { render = $2 }
    /"build_s"/ { build = $2 }
    /"speeds"/ { for (i = 3; i < NF; i++) speed[n++] = $i }
    END {
        for (i = 0; i < n; i++) {
            part = render + build - i * span
            sum += speed[i] * (part < span ? part : span)
        }
        exit !(sum > 199000 && sum < 201000)
    }' run.json || die "speeds: $(cat run.json)"

fresh
size=120x24
start_line "LC_ALL=C TERM=tmux-256color glim -t 1 --stats - lamp.obj"
wait_for "LIVE .* spp"
wait_for "noise of the samples"
wait_for "[#|:][#|:]* *[.]*" # the graph
keys g
wait_for "about this render"
wait_for "CPU, 1 thread  *busy"
keys C-q
expect_end 0 cleared
expect '"percent": null,'

# a terminal that shows Unicode does not change what curses can write
fresh
start_line "unset TMUX; LC_ALL=C TERM=xterm-256color glim -t 1 lamp.obj"
wait_for "LIVE .* spp"
wait_for "[#|:][#|:]* *[.]*"
reject "[?][?]"
keys C-q
expect_end 0

fresh
start --stats nowhere/run.json lamp.obj
wait_for "nowhere: no such file or folder"
wait_for "^exit 1"
