#!/bin/bash
# SPDX-License-Identifier: MIT
# render.sh - renders the README's pictures (`make gallery`)
#
# Pictures are small and have little noise; this takes some minutes. screen.png,
# panel.png, compare.png and open.png were taken from a real terminal and are
# not made here.
set -eu
cd "$(dirname "$0")/../.."
glim=${BUILD:-build/release}/glim

render() # scene, width, samples
{
    "$glim" -b -w "$2" -s "$3" -o "scenes/gallery/$1.png" "scenes/$1.obj"
    echo "scenes/gallery/$1.png"
}

render cornell 240 400
render materials 320 300
render glass_mirror 320 700
render interior 320 700
render skylit 320 300
render lights200 320 500
render principled 480 400
for glass in globe bulb lantern water prism milk; do
    "$glim" -b -w 480 -s 128 --denoise -o "scenes/gallery/$glass.png" \
        "scenes/$glass.obj"
    echo "scenes/gallery/$glass.png"
done

model() # model, samples, option...
{
    "$glim" -b -w 320 -s "$2" --denoise "${@:3}" \
        -o "scenes/gallery/$1.png" "scenes/$1.glb"
    echo "scenes/gallery/$1.png"
}

"$glim" -b -w 480 -s 256 --denoise -o scenes/gallery/fog.png scenes/fog.obj
echo scenes/gallery/fog.png
"$glim" -b -w 480 -s 256 --denoise -o scenes/gallery/busts.png scenes/busts.glb
echo scenes/gallery/busts.png
model chess 500
model bottles 1500
model bubbles 1500
model knot 500
model forest 400
model jellyfish 500 --anim-time 0.75
"$glim" -b -w 400 --show normals -o scenes/gallery/normals.png \
    scenes/materials.obj
