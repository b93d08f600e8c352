# SPDX-License-Identifier: MIT
# Several ranks make the bytes that one makes: started by mpirun, or by the
# program itself.
mpi_program
take box
b="-b -w 48 -h 36 -t 1"
for options in '-s 40' '-s 24 --adaptive --denoise' '-e 20%'; do
    glim $b $options -o one.png box.obj 2>/dev/null
    for count in 2 4; do
        ranks $count $b $options -o many.png box.obj >/dev/null
        same many.png one.png
    done
    timeout -k 5 60 "$mpi" $b $options --ranks 3 -o many.png box.obj 2>/dev/null
    same many.png one.png
done

# so do they with media, whose files rank 0 alone reads
npy '2, 2, 2' '\377\100\000\020\200\100\377\000' >smoke.npy
cp box.obj smoke.obj
cat - box.view >smoke.view <<END
fog scatter .1 .2 .3 anisotropy .5 height .5 falloff 1
medium smoke.npy scatter .01 .02 .03 absorb .01 0 0 box -1 0 -1 1 2 1
END
for scene in smoke.obj "$root/scenes/fog.obj" "$root/scenes/prism.obj"; do
    glim $b -s 9 -o one.pfm "$scene" 2>/dev/null
    ranks 2 $b -s 9 -o many.pfm "$scene" >/dev/null
    same many.pfm one.pfm
done

# so do they for the pictures of a series, whose scene changes
take moving
for options in '--turntable 2 box.obj' '--frames 1:2 moving.gltf' \
    "--turntable 2 $root/scenes/forest.glb"; do
    glim $b -s 9 -o one.png $options 2>/dev/null
    ranks 3 $b -s 9 -o many.png $options >/dev/null
    for i in 0000 0001 0002; do
        [ -e one-$i.png ] && same many-$i.png one-$i.png
    done
    rm one-*.png
done

# all ranks have rendered, and their samples together are those of the picture
timeout -k 5 60 mpirun --oversubscribe -n 3 "$mpi" $b -w 480 -h 360 -s 16 \
    --stats ranks.json -o many.png box.obj 2>/dev/null
awk -F '[:,]' '/"samples":/ { if (/answers/) { sum += $2; ranks++; none += $2 == 0 }
        else all = $2 }
    END { print ranks " ranks, " none " without samples, " \
        (sum == all ? "all" : sum " of " all) " samples" }' ranks.json
