# SPDX-License-Identifier: MIT
# The models that are shipped are read whole: what they hold, and no warning.
for model in chess bottles bubbles knot forest jellyfish; do
    run_untimed -b -w 32 -s 1 --stats s.json -o a.png "$root/scenes/$model.glb"
    tr -d ' ,"' <s.json | grep -E '^(triangles|instances):' | tr '\n' ' '
    echo
done
# time moves bones and weights
for time in 0 0.5 2; do
    glim -b -w 64 --show depth --anim-time $time -o $time.png \
        "$root/scenes/jellyfish.glb" 2>/dev/null
done
same 0.png 0.5.png
same 0.png 2.png
