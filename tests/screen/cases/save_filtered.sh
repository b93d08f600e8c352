# SPDX-License-Identifier: MIT
# p saves what is seen: the filtered picture in full size, of a fraction of the
# error; with its noise if it changes meanwhile, or by command. The metadata
# tell.
size=80x24
cp "$root"/scenes/interior.* "$root"/scenes/*.png .
relmse() # PICTURE
{
    glim compare "$1" reference.png | sed -n 's/^relMSE *//p'
}
glim -b -w 480 -h 270 -s 64 --denoise -o reference.png interior.obj 2>/dev/null
start -w 480 -h 270 interior.obj
wait_for "LIVE  filtered  *[2-9] spp"
keys p
wait_for "saved interior.png 480x270, [0-9]* spp, filtered"
filtered_spp=$(screen | sed -n 's/.*480x270, \([0-9]*\) spp, filtered.*/\1/p')
grep -aq "denoised" interior.png || die "no metadata of the filter"
raw_keys ':raw'
wait_for "save a PNG with its noise"
keys Enter
wait_for "saved interior-2.png 480x270, [0-9]* spp, with its noise"
noisy_spp=$(screen | sed -n 's/.*480x270, \([0-9]*\) spp, with its.*/\1/p')
! grep -aq "denoised" interior-2.png || die "metadata of the filter"
filtered=$(relmse interior.png)
noisy=$(relmse interior-2.png)
# noise of as many samples as the filter had: on a busy machine it had fewer
awk "BEGIN { exit !(8 * $filtered < $noisy * $noisy_spp / $filtered_spp) }" ||
    die "filtered $filtered at $filtered_spp, with noise $noisy at $noisy_spp"
# drawings are over the filtered picture
keys t
wait_for "boxes of level"
keys p
wait_for "saved interior-3.png 480x270, as it is shown"
awk "BEGIN { exit !(2 * $(relmse interior-3.png) < $noisy) }" ||
    die "with a drawing: $(relmse interior-3.png), with noise $noisy"
# live mode can be left while a picture is being saved
keys Escape
wait_for "LIVE  filtered"
keys p Space
wait_for "NORMAL ready  normal mode"
wait_for "NORMAL ready  saved interior-4.png"
keys C-q
expect_end 0
