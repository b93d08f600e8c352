# SPDX-License-Identifier: MIT
# The panel of progress: numbers as text, also where the window is small and
# there is no Unicode; the same as JSON at the end.
lamp_scene
size=80x24
start --stats run.json -s 40 -t 2 lamp.obj
wait_for "LIVE .* spp"
keys g
wait_for "┌─ progress ─"
wait_for "spp  *no limit"
wait_for "2 threads  *busy [0-9]* %"
wait_for "samples/s .*, most "
keys Space Enter
wait_for "40 of 40 spp  *100.0 %"
wait_for "██████████"
wait_for "samples  *200 k .*/s"
wait_for "busy 0 %"
# it is still there after the help and after another size, and at rest
keys '?'
wait_for "Esc back"
reject "progress ─"
keys Escape
wait_for "┌─ progress ─"
wait_for "40 of 40 spp  *100.0 %"
mux resize-window -x 60 -y 20
wait_for "samples  *200 k .*/s"
wait_until rests
keys g
wait_until_gone "progress"
keys g
wait_for "progress"
keys i # nothing but the picture
wait_until_gone "progress"
reject "NORMAL"
keys i
wait_for "NORMAL done"
reject "progress"
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
start_line "LC_ALL=C TERM=tmux-256color glim -t 1 --stats - lamp.obj"
wait_for "LIVE .* spp"
keys g
wait_for "progress"
wait_for "samples/s .*, most "
wait_for " [#|:.][#|:.]* "
wait_for "1 thread  *busy"
keys C-q
expect_end 0 cleared
expect '"percent": null,'

fresh
start --stats nowhere/run.json lamp.obj
wait_for "nowhere: no such file or folder"
wait_for "^exit 1"
