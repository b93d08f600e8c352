# SPDX-License-Identifier: MIT
# --up z: (x, y, z) of the file is (x, z, -y).
take box
awk '$1 == "v" { print "v", $2, -$4, $3; next } { print }' box.obj >zup.obj
cp box.view zup.view
b="-b -w 24 -h 16 -s 2"
glim $b -o y.pfm box.obj 2>/dev/null
glim $b --up z -o z.pfm zup.obj 2>/dev/null
same y.pfm z.pfm
glim $b --up y -o zy.pfm zup.obj 2>/dev/null
same y.pfm zy.pfm
