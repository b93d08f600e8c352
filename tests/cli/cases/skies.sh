# SPDX-License-Identifier: MIT
# Values of a sky image that are not radiances: NaN is refused, negative and
# infinite values are clamped and counted.
take plain
b="-b -w 8 -h 4 -s 1 -o out.png"
one='\000\000\200\077'
texel() { # NAME VALUE: a sky of two texels, the last number of which is VALUE
    printf "PF\n2 1\n-1\n$one$one$one$one$one$2" >"$1"
}
echo 'sky sky.pfm' >plain.view
texel sky.pfm "$one"
run_untimed $b plain.obj
texel sky.pfm '\000\000\200\277'
run_untimed $b plain.obj
texel sky.pfm '\000\000\200\177'
run_untimed $b plain.obj
rm out.png
texel sky.pfm '\000\000\300\177'
run_untimed $b plain.obj
kind out.png 2>/dev/null
