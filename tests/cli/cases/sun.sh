# SPDX-License-Identifier: MIT
# The sun: values that it refuses, the ends of their ranges, and the night.
take plain
b="-b -w 8 -h 4 -s 1 -o out.png"
for sun in '' 90 90, ,45 90,91 90,-90.1 361,1 nan,1 1,inf 1,2,3 '1, 2'; do
    run $b --sun "$sun" plain.obj
done
for turbidity in '' 1.6 10.1 nan -3; do
    run $b --sun 0,45 --turbidity "$turbidity" plain.obj
done
run $b --turbidity 4 plain.obj
run compare --sun 0,45 a.pfm b.pfm
for sun in 0,90 360,1e-9 -360,0 0,-90; do
    run_untimed $b --sun $sun --turbidity 1.7 plain.obj
    run_untimed $b --sun $sun --turbidity 10 plain.obj
done
# a sun replaces a sky image, which is not read then
printf 'sun 120 30\nsky none.hdr\nturbidity 10\n' >plain.view
run_untimed $b plain.obj
run_untimed $b --turbidity 2 plain.obj
for line in 'sun 1' 'sun 1 91' 'sun 1 2 3' 'sun x 2' 'turbidity 1' turbidity; do
    echo "$line" >plain.view
    run $b plain.obj
done
