# SPDX-License-Identifier: MIT
# Lights of the view file: lines that it refuses, and a picture by their light
# alone.
take plain
b="-b -w 8 -h 4 -s 1 -o out.png"
for line in light 'light bulb 1 2 3' 'light point 1 2' 'light point 1 2 nan' \
    'light point 1 2 3 radius -1' 'light point 1 2 3 at 0 0 0' \
    'light point 1 2 3 intensity 1e31 0 0' 'light spot 1 2 3' \
    'light spot 1 2 3 at 1 2 3' 'light spot 1 2 3 at 0 0 0 inner 9 outer 8' \
    'light directional 1' 'light directional 1 91' \
    'light directional 1 2 angle 200'; do
    echo "$line" >plain.view
    run $b plain.obj
done
# no soft sky
printf 'light point 1 2 3\nlight spot 1 2 3 at 0 0 0 radius 1e30\n' >plain.view
printf 'light directional -360 -90\nlight point 0 0 0 intensity 0 0 0\n' \
    >>plain.view
run_untimed $b plain.obj
# lamps of IES files
ies() {
    printf 'IESNA91\n%s\n1 1 1 2 1 %s 2 0 0 0\n1 1 1\n0 90\n0\n%s\n' "$@" >a.ies
    echo 'light point 0 2 0 ies a.ies' >plain.view
    run_untimed $b plain.obj
}
ies TILT=INCLUDE 1 '5 0'
ies TILT=NONE 3 '5 0'
ies TILT=NONE 1 '5'
ies TILT=NONE 1 '5 x'
for line in 'light point 0 2 0 ies' 'light spot 0 2 0 at 0 0 0 ies no.ies' \
    'light directional 1 2 ies a.ies'; do
    echo "$line" >plain.view
    run_untimed $b plain.obj
done
