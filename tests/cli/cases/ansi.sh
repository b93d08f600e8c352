# SPDX-License-Identifier: MIT
# --ansi writes the picture as text, to standard output or to a file.
printf 'v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n' >flat.obj
printf 'eye 0 0 5\nat 0 0 0\nres 20 10\nbackground .5 .2 0\n' >flat.view
text()
{
    glim -b -s 1 "$@" flat.obj 2>err </dev/null
    echo "exit $?"
    untimed err
}
# 2:1 in 8x8 cells of 1:2 is 8x2
text --ansi 8x8 | cat -v
text --ansi 8x8 --cell-aspect 1 --color 16 --glyph half | cat -v
NO_COLOR=1 text --ansi=4x4 -o - | cat -v
NO_COLOR=1 text --ansi 4x4 --color 24bit | cat -v
# ASCII works in every locale, braille only in UTF-8
LC_ALL=C NO_COLOR=1 text --ansi=4x4 | cat -v
LC_ALL=C.UTF-8 NO_COLOR=1 text --ansi=4x4
NO_COLOR= GLIM_COLOR=mono text --ansi 4x4 --glyph braille | cat -v
text --ansi 4x4 -o picture.ans
text --ansi 4x4 >expected
head -n 1 picture.ans | cat -v
glim -b -s 1 --ansi 4x4 flat.obj 2>/dev/null | cmp - picture.ans && echo same
text --ansi 4x4 --stats - | cat -v
text --ansi 4 | cat -v
text --ansi 4x0 | cat -v
text --ansi 4x4 --glyph sixel | cat -v
text --ansi 4x4 -o none/picture.ans
run --ansi 4x4 flat.obj
run -b -o picture.ans flat.obj
