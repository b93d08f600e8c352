#!/bin/bash
# SPDX-License-Identifier: MIT
# films.sh - ways to the same samples, which give the same bytes
#
# usage: films.sh GLIM FOLDER SCENE...
#
# Each scene is rendered in forty ways: with other numbers of threads, other
# instruction sets, on an OpenCL device, stopped and resumed, killed and
# resumed, in shares that are merged, and where MPI is installed by the ranks of
# a cluster. All of them have one SHA-256. Then a
# render is killed a thousand times: its checkpoint is always a whole film, with
# at least the samples of the one before. Prints a row for each scene.
set -u
glim=$1
folder=$2
shift 2
mpi=$(dirname "$glim")/mpi/glim
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
RANDOM=20

size='-w 120 -h 90'
spp=48

# Renders the scene with these options. The name of the way is in $way.
render()
{
    # shellcheck disable=SC2086 # words
    "$glim" -b $size "$@" -o "$folder/way.png" "$scene" 2>"$folder/said"
}

# Compares the picture with the first one.
count()
{
    ways=$((ways + 1))
    if cmp -s "$folder/way.png" "$folder/first.png"; then
        same=$((same + 1))
    else
        echo "  $scene: $way: another picture"
        tail -n 2 "$folder/said"
    fi
    rm -f "$folder/way.png"
}

# Renders and compares.
try() # NAME OPTION...
{
    way=$1
    shift
    render "$@"
    count
}

# Renders some samples, and the rest with other options.
resumed() # OPTIONS OF BOTH PARTS, AS WORDS
{
    local first=$((1 + RANDOM % (spp - 1)))

    way="resumed at $first samples: $1, then $2"
    # shellcheck disable=SC2086 # words
    render -s $first $1 --film "$folder/part.film"
    # shellcheck disable=SC2086 # words
    render -s $spp $2 --resume "$folder/part.film"
    count
}

# Interrupts a render up to three times at random and lets it go on.
interrupted() # SIGNAL OPTION...
{
    local signal=$1

    shift
    way="interrupted by SIG$signal: $*"
    rm -f "$folder/check.film"
    for _ in 1 2 3; do
        # shellcheck disable=SC2086 # words
        timeout --foreground -s "$signal" 0.$((20 + RANDOM % 60)) \
            "$glim" -b $size -s $spp "$@" --checkpoint "$folder/check.film" \
            --checkpoint-interval 0.1 --resume "$folder/check.film" \
            -o "$folder/way.png" "$scene" 2>"$folder/said"
    done
    rm -f "$folder/way.png"
    render -s $spp "$@" --checkpoint "$folder/check.film" \
        --resume "$folder/check.film"
    count
}

merged() # NUMBER...
{
    way="merged: $*"
    "$glim" merge -o "$folder/way.png" "${@/%/.film}" 2>"$folder/said"
    count
}

# Ranks of a cluster, also with a device, and four that are killed and go on as
# two.
cluster()
{
    local count command

    [ -x "$mpi" ] && command -v mpirun >/dev/null || return
    for count in 4 3 2; do
        way="$count ranks"
        # shellcheck disable=SC2086 # words
        timeout -k 5 120 mpirun --oversubscribe -n $count "$mpi" -b $size \
            -s $spp -t 1 -o "$folder/way.png" "$scene" >"$folder/said" 2>&1
        count
    done
    way='2 ranks with OpenCL'
    # shellcheck disable=SC2086 # words
    timeout -k 5 240 mpirun --oversubscribe -n 2 "$mpi" -b $size -s $spp \
        --backend opencl -o "$folder/way.png" "$scene" >"$folder/said" 2>&1
    count
    way='4 ranks, killed, and resumed by 2'
    rm -f "$folder/check.film"
    for command in 'timeout -s KILL 1.4 mpirun --oversubscribe -n 4' \
        'timeout -k 5 120 mpirun --oversubscribe -n 2'; do
        rm -f "$folder/way.png"
        # shellcheck disable=SC2086 # words
        $command "$mpi" -b $size -s $spp -t 1 --resume "$folder/check.film" \
            --checkpoint "$folder/check.film" --checkpoint-interval 0.1 \
            -o "$folder/way.png" "$scene" >"$folder/said" 2>&1
    done
    count
    way='--ranks 3'
    # shellcheck disable=SC2086 # words
    timeout -k 5 120 "$mpi" -b $size -s $spp -t 1 --ranks 3 \
        -o "$folder/way.png" "$scene" >"$folder/said" 2>&1
    count
}

forty_ways() # SCENE
{
    local isa threads

    scene=$1
    ways=0
    same=0
    rm -f "$folder/"*.film
    render -s $spp --film "$folder/whole.film"
    mv "$folder/way.png" "$folder/first.png"
    for isa in $("$glim" --version | sed -n 's/^isa://p') plain plain; do
        [ $ways -lt 9 ] || break
        for threads in 1 2 3; do
            try "$isa, $threads threads" -s $spp --isa "$isa" -t $threads
        done
    done
    try OpenCL -s $spp --backend opencl
    for threads in 1 2 3 4; do
        resumed "-t $threads" "-t $((5 - threads)) --isa plain"
        resumed "--isa plain -t 2" "-t $threads"
    done
    resumed '--backend opencl' '-t 2'
    resumed '-t 2' '--backend opencl'
    resumed '--backend opencl' '--isa plain'
    resumed '--backend opencl' '--backend opencl'
    for _ in 1 2 3 4; do
        interrupted KILL -t 1
    done
    interrupted KILL -t 2
    interrupted KILL --backend opencl
    interrupted TERM -t 1
    interrupted INT -t 2
    interrupted HUP -t 1
    for i in 1 2 3; do
        render -s $spp --share $i/3 --film "$folder/$i.film"
    done
    (cd "$folder" && "$glim" merge -o 31.film 3.film 1.film) 2>/dev/null
    render -s $spp --share 2/3 --film "$folder/cl.film" --backend opencl
    cd "$folder" || exit 2
    merged 1 2 3
    merged 1 3 2
    merged 2 1 3
    merged 2 3 1
    merged 3 1 2
    merged 3 2 1
    merged 2 31
    merged 1 cl 3
    cluster
    way=developed
    "$glim" develop -o way.png whole.film 2>said
    count
    cd - >/dev/null || exit 2
    if [ $same = $ways ] && [ $ways -ge 40 ]; then
        echo "ok films $scene: $ways ways, SHA-256" \
            "$(sha256sum "$folder/first.png" | cut -c 1-16)"
    else
        echo "FAIL films $scene: $same of $ways ways have the same bytes"
    fi
}

# The end of the samples in the checkpoint; 0 without one. Fails for a torn one.
samples_of()
{
    [ -f "$folder/check.film" ] || { echo 0; return; }
    "$glim" info "$folder/check.film" >"$folder/info" || return 1
    sed -n 's/^  samples *0 to //p' "$folder/info"
}

thousand_kills()
{
    local before=0 now=0 torn=0 lost=0 rounds=0

    scene=$1
    rm -f "$folder/check.film"
    for _ in $(seq 1000); do
        timeout --foreground -s KILL 0.$((100 + RANDOM % 200)) "$glim" -b \
            -w 64 -h 48 -s 2000 -t 1 --resume "$folder/check.film" \
            --checkpoint "$folder/check.film" --checkpoint-interval 0.1 \
            -o "$folder/way.png" "$scene" 2>"$folder/said" &&
            rm "$folder/check.film" && before=0 && rounds=$((rounds + 1))
        now=$(samples_of) || torn=$((torn + 1))
        [ "${now:-0}" -ge "$before" ] || lost=$((lost + 1))
        before=${now:-0}
    done 2>/dev/null
    if [ $torn = 0 ] && [ $lost = 0 ]; then
        echo "ok films 1,000 kills: no torn film, none older, $rounds renders whole"
    else
        echo "FAIL films 1,000 kills: $torn torn films, $lost older than before"
    fi
}

for scene; do
    forty_ways "$scene"
done
thousand_kills "$1"
