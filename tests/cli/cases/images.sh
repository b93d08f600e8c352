# SPDX-License-Identifier: MIT
# Images with fewer pixels than their header says are refused, with the line
# that names them.
b="-b -w 8 -h 8 -s 1 -t 1 -o out.png"
textured 3
# 19 bytes for 32767x8191 pixels, 161 for 16136x6656 of them
printf '\0\0\2\0\0\0\0\0\0\0\0\0\377\177\377\037\040\0x' >1.tga
{
    printf '\0\0\012\0\0\0\0\0\0\0\0\0\010\077\0\032\020\003'
    printf '%143s' ''
} >2.tga
printf '8BPS no picture' >3.tga
run_untimed $b textured.obj
