# SPDX-License-Identifier: MIT
# --crop renders the same pixels as the whole picture.
take box
glim -b -w 24 -h 16 -s 60 -o whole.pfm box.obj 2>/dev/null
run_untimed -b -w 24 -h 16 -s 60 --crop 5,2,13,9 -o part.pfm box.obj
kind part.pfm
# PFM has the lowest row first: rows 10 to 2 from the top
floats whole.pfm 24 16 | awk '
    { x = (NR - 1) % 24; y = 15 - int((NR - 1) / 24) }
    x >= 5 && x < 18 && y >= 2 && y < 11' >expected
floats part.pfm 13 9 >found
wc -l <found | tr -d ' '
same expected found
sort -u found | wc -l | awk '{ print ($1 > 20 ? "not flat" : "flat") }'
run -b -w 24 -h 16 --crop 12,8,13,8 -o part.pfm box.obj
run -b -w 24 -h 16 --crop 0,65536,1,1 -o part.pfm box.obj
run_untimed -b -w 24 -h 16 -s 1 --crop 23,15,1,1 -o part.pfm box.obj
