# SPDX-License-Identifier: MIT
# Cameras of a glTF file by number and name, and frames of its animation.
take box moving
b="-b -w 24 -h 16 -s 2"
run $b --camera 3 moving.gltf
run $b --camera Side moving.gltf
glim $b -o 1.png moving.gltf 2>/dev/null
for camera in 1 Front; do
    glim $b -o camera.png --camera $camera moving.gltf 2>/dev/null
    same 1.png camera.png
done
glim $b -o 2.png --camera Far moving.gltf 2>/dev/null
glim $b -o camera.png --camera 2 moving.gltf 2>/dev/null
same 2.png camera.png
same 1.png 2.png
# the camera is at 0.5 0 9 and looks along -z; yfov is 0.4 radians
glim $b -o 2.pfm --camera Far moving.gltf 2>/dev/null
glim $b -o camera.pfm --eye 0.5,0,9 --at 0.5,0,8 --fov 22.918312 moving.gltf \
    2>/dev/null
same 2.pfm camera.pfm

for fps in 0 1001 x; do
    run $b --frames 0:1 --fps $fps moving.gltf
done
run $b --frames 0:1 --anim-time 1 moving.gltf
run --frames 0:1 moving.gltf
run $b --frames 0:1 box.obj
# frame k is at k / fps seconds: the sail moves by 1 in a second
run_untimed $b --frames 0:24 -o a.png moving.gltf | tail -n 3
for frame in 0000:0 0006:0.25 0024:1; do
    glim $b -o one.png --anim-time ${frame#*:} moving.gltf 2>/dev/null
    same a-${frame%:*}.png one.png
done
same a-0000.png a-0006.png
run_untimed $b --frames 2:2 --fps 8 -o e.png moving.gltf
same a-0006.png e-0002.png
glim $b --frames 12:12 --aov position -o p.pfm --camera Far -w 1 -h 1 \
    moving.gltf 2>/dev/null
floats p-0012.position.pfm 1 1
