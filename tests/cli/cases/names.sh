# SPDX-License-Identifier: MIT
# Control characters in names of files, materials, objects and keys do not reach
# the terminal; JSON has escapes for them.
esc=$(printf '\033]0;X\007')
c1=$(printf '\23331m')
odd="q$esc$c1$(printf '\302\2331m \342\200\256 \377 \177 \nx')"
face='v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n'
mkdir hostile
cd hostile

# Tells whether a byte is neither a character of ASCII or UTF-8 nor a line end.
clean()
{
    if LC_ALL=C grep -aq '[^ -~]' "$1"; then
        echo "$1: has control characters"
        od -c "$1" | head
    else
        echo "$1: $(wc -l <"$1") lines, clean"
    fi
}

{
    printf 'newmtl %s\nmap_Kd no%s.png\n%s 1\n' "$esc$c1" "$esc" "x$c1"
    printf 'Kd spectral a%s\nNs -1\n' "$c1"
} >"m$esc.mtl"
{
    printf 'mtllib m%s.mtl no%s.mtl\n' "$esc" "$c1"
    printf 'usemtl no%s\no %s\n%s\n' "$esc$c1" "$esc$c1" "y$esc"
    printf "$face"
    printf 'f 1/%s 2 3\nf 99%s 1 2\n' "$c1" "$esc"
} >"$odd.obj"
printf 'shutter%s 1\nassign %s %s\n' "$esc" "$esc$c1" "no$c1" >"$odd.view"
glim -b -w 8 -h 4 -s 1 --stats run.json "$odd.obj" >out 2>err
echo "exit $?"
clean out
clean err
clean run.json
grep '"scene"' run.json
untimed err

echo '- errors'
refused()
{
    glim -b -s 1 -w 4 -h 4 "$@" >out 2>err </dev/null
    echo "exit $?: $(grep -ac '^glim: ' err)"
    clean err
}
refused "none$esc.obj"
refused -c "none$c1" "$odd.obj"
refused -o "$esc" "$odd.obj"
refused -o "x$c1/a.png" "$odd.obj"
refused --device "$esc" "$odd.obj"
refused "--$esc"
refused "-$c1"
refused -w "8$esc"
refused --glyph "$c1"
refused --kernels "x$c1" --device 1 "$odd.obj"
refused --stats "x$esc/y" "$odd.obj"

echo '- characters of UTF-8 stay where LC_CTYPE has them'
LC_ALL=C.UTF-8 glim -b "nöne$(printf '\302\233\342\200\256').obj" 2>err
cat err
