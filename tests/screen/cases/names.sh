# SPDX-License-Identifier: MIT
# Foreign names in the panel: what stands behind them is in one column, whatever
# they are made of, and none of them gets into the next row.
wide='日本語の材料名前がとても長い'
odd=$(printf 'tab\tand\033[31m')
: >names.mtl
printf 'mtllib names.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\n' >names.obj
for name in plain ünïcödé "$wide" "$odd" "$(printf '%0200d' 0)"; do
    printf 'newmtl %s\nKd 1 1 1\n' "$name" >>names.mtl
    printf 'o of %s\nusemtl %s\nf 1 2 3\n' "$name" "$name" >>names.obj
done
size=80x24
start names.obj
wait_for LIVE
keys Tab
wait_for "│>....plain             diffuse"
expect "│.....ünïcödé           diffuse"
expect "│.....日本語の材料名前  diffuse"
expect "│.....tab?and?\[31m      diffuse"
expect "│.....00000000000000000 diffuse"
keys Tab
wait_for "│>....of plain          plain"
expect "│.....of ünïcödé        ünïcödé"
expect "│.....of 日本語の材料名 日本語の材料"
expect "│.....of tab?and?\[31m   tab?and?\[31m"
# every row has the bar
wait_until eval "screen | grep -c '│' | grep -qx 23"
keys C-q
wait_for "^exit 0"
fresh

# the scene's own name, on the status line, in messages and in what is left
# behind on the shell's screen
odd=$(printf 'q\033]0;X\007\302\2331m')
cp names.obj "$odd.obj"
start "\"\$(printf 'q\\033]0;X\\007\\302\\2331m').obj\""
wait_for LIVE
keys Escape # a message
wait_for "LIVE .*[1-9][0-9]* spp"
keys c
wait_for 'wrote the view to q?\]0;X??1m.view'
keys p
wait_for 'saved q?\]0;X??1m.png'
keys C-q
wait_for "^exit 0"
expect '^wrote the view to q?\]0;X??1m.view'
expect '^saved q?\]0;X??1m.png'
[ "$(mux display-message -p '#{pane_title}')" != X ] || die "another title"
