# SPDX-License-Identifier: MIT
# -d N limits a path to N + 1 surfaces. 0 shows only the lamp, whose radiance is
# 8. The option overrides the view file.
take box
b="-b -w 24 -h 16 -s 20"
glim $b -d 0 -o d0.pfm box.obj 2>/dev/null
glim $b -d 1 -o d1.pfm box.obj 2>/dev/null
floats d0.pfm 24 16 | awk '
    $1 > 0 { lit++ }
    $1 > 8.001 { bright++ }
    END { print (lit > 0 && lit < 60 ? "only the lamp" : "lit: " lit),
                bright + 0 }'
floats d1.pfm 24 16 | awk '
    $1 > 0 { lit++ } END { print (lit > 60 ? "more" : "no more") }'
echo 'max_bounces 0' >>box.view
glim $b -o v0.pfm box.obj 2>/dev/null
same d0.pfm v0.pfm
glim $b -d 1 -o v1.pfm box.obj 2>/dev/null
same d1.pfm v1.pfm
