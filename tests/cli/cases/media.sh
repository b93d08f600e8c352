# SPDX-License-Identifier: MIT
# Media: a render that is killed and goes on, on other threads and instructions,
# or in shares, has the bytes of one that does not.
for scene in fog milk prism; do
    cp "$root/scenes/$scene".* .
done
cp "$root"/scenes/busts.* "$root"/scenes/*.png .
take box
mv box.obj smoke.obj
cat - box.view >smoke.view <<END
fog scatter .1 .2 .3 absorb 0 0 .1 anisotropy .5 height .5 falloff 1
medium smoke.npy scatter .01 .02 .03 absorb .01 0 0 box -1 0 -1 1 2 1
medium smoke.npy scatter .02 .02 .02 anisotropy .6 box 0 .5 -.5 .5 1 .5
END
npy '3, 2, 2' '\377\100\000\020\200\100\377\000\001\377\030\100' >smoke.npy

for scene in fog.obj milk.obj prism.obj busts.glb smoke.obj; do
    b="-b -w 16 -h 12 --seed 3"
    rm -f c.film
    glim $b -t 1 -s 1000000 --checkpoint c.film --checkpoint-interval 0.1 \
        -o x.png $scene 2>/dev/null &
    until [ -f c.film ]; do sleep 0.01; done
    kill -KILL $!
    wait $! 2>/dev/null
    # a pass that was cut has at most 64 samples
    has=$(glim info c.film | sed -n 's/^  samples *0 to //p')
    spp=$((has + 64))
    glim $b -t 1 -s $spp -o whole.pfm $scene 2>/dev/null
    glim $b -t 2 -s $spp --isa plain --resume c.film -o $scene.pfm $scene \
        2>/dev/null
    same $scene.pfm whole.pfm
    for i in 1 2; do
        glim $b -s 4 --share $i/2 --film $i.film -o x.png $scene 2>/dev/null
    done
    glim merge -o $scene.pfm 2.film 1.film 2>/dev/null
    glim $b -s 4 -o whole.pfm $scene 2>/dev/null
    same $scene.pfm whole.pfm
done
