# SPDX-License-Identifier: MIT
# Several ranks make the bytes that one makes: started by mpirun, or by the
# program itself.
mpi=${BUILD:-build/release}/mpi/glim
case $mpi in
/*) ;;
*) mpi=$root/$mpi ;;
esac
command -v mpirun >/dev/null || skip no mpirun
[ -x "$mpi" ] || skip no program with MPI
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
take box

ranks() # COUNT OPTION...
{
    count=$1
    shift
    timeout -k 5 60 mpirun --oversubscribe -n $count "$mpi" "$@" 2>&1 |
        grep -E 'glim|spp' | untimed
}

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

# ranks that the program starts have its kernels and instruction set
cp -r "$root/kernels" k
echo '/* another version */' >>k/path.h
glim $b -s 3 -o one.pfm box.obj 2>/dev/null
timeout -k 5 100 "$mpi" $b -s 3 --ranks 2 --kernels k -o many.pfm box.obj \
    2>&1 | grep -E 'glim|spp' | untimed # the MPI library may complain
same many.pfm one.pfm
timeout -k 5 60 "$mpi" $b -s 100000 -w 320 --ranks 2 --isa plain -o many.png \
    box.obj 2>/dev/null &
until pgrep -f -- "$mpi --worker --backend cpu --isa plain -t 1" >/dev/null; do
    sleep 0.1
done
kill $!
wait $! 2>/dev/null
echo "ended by a signal: $?"

# a killed job goes on, with another number of ranks
glim $b -s 300 -w 96 -o one.png box.obj 2>/dev/null
timeout -s KILL 1.5 mpirun --oversubscribe -n 4 "$mpi" $b -w 96 -s 300 \
    --checkpoint c.film --checkpoint-interval 0.1 -o many.png box.obj \
    >/dev/null 2>&1
while pgrep -f -- "$mpi.* --checkpoint c.film" >/dev/null; do
    sleep 0.1 # ranks outlive mpirun until they notice that it is gone
done
ranks 2 $b -s 300 -w 96 --checkpoint c.film --resume c.film -o many.png box.obj
same many.png one.png

# one line about a mistake, from rank 0
ranks 4 -b none.obj
ranks 4 --none
run -b --ranks 4 box.obj
