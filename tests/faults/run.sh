#!/bin/bash
# SPDX-License-Identifier: MIT
# run.sh - lets calls of glim fail, one after another
#
# usage: run.sh [STEP]
#
# Each run of glim here is repeated with its first, second, ... allocation
# failing, every STEP-th one, then with threads that do not start and with
# system calls that return errors, if strace is there. Each time glim must
# write the right picture, or say in one line why there is none and leave
# nothing behind. Films are whole: those from before, or the new ones. The
# screen must be left as it was found. Calls of an OpenCL driver fail, once or
# from then on, or do not return: the CPU goes on, and the picture is the same.
#
# BUILD is the folder of the program; FILTER=PART selects runs by name. Rows are
# those of `make stress`.
cd "$(dirname "$0")/../.." || exit 1
build=$(realpath "${BUILD:-build/release}")
scenes=$PWD/scenes
step=${1:-1}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export FAULT_COUNT=$work/count XDG_STATE_HOME=$work/state
glim=$build/glim
failed=0
small='-b -w 16 -h 9 -s 2 -t 2'

# Runs the command in an empty folder, with what the run before left in `given`.
# `with` is a prefix that makes a call fail.
attempt() # WITH... -- COMMAND...
{
    local with=()

    while [ "$1" != -- ]; do
        with+=("$1")
        shift
    done
    shift
    rm -rf "$work/run" "$work/state" "$FAULT_COUNT"
    cp -r "$work/given" "$work/run"
    (cd "$work/run" && timeout 150 "${with[@]}" "$@" </dev/null >"$work/out" \
        2>"$work/said")
    status=$?
}

# Prints which files of two folders differ. Pictures and films name the time that
# they took, and count by their pixels.
differing()
{
    local line name

    diff -rq "$1" "$2" | while read -r line; do
        name=${line% differ}
        name=${name##*/}
        case $line in
        Files*.png\ differ | Files*.exr\ differ | Files*.hdr\ differ)
            "$glim" compare "$1/$name" "$2/$name" >/dev/null || echo "$line"
            ;;
        Files*.film\ differ) is_same_film "$1/$name" "$2/$name" || echo "$line" ;;
        *) echo "$line" ;;
        esac
    done
}

# Compares films by what they say of themselves, without the time, and by their
# pixels.
is_same_film()
{
    local n=0 film

    for film in "$1" "$2"; do
        n=$((n + 1))
        "$glim" info "$film" | sed -e 1d -e '/^  time /d' >"$work/info$n"
        "$glim" develop "$film" -o "$work/$n.pfm" 2>/dev/null || return
    done
    cmp -s "$work/info1" "$work/info2" && cmp -s "$work/1.pfm" "$work/2.pfm"
}

# Prints what is wrong after an attempt, if anything is.
wrong()
{
    local lines warnings

    lines=$(grep -c '^glim: ' "$work/said")
    warnings=$(grep -c '^glim: warning: ' "$work/said")
    if grep -q 'while loading shared libraries' "$work/said"; then
        return
    elif [ "$status" = 0 ]; then
        [ "$warnings" != 0 ] || differing "$work/run" "$work/good"
    elif [ "$status" != 1 ]; then
        echo "status $status"
    elif [ "$lines" != 1 ] || [ "$(wc -l <"$work/said")" != 1 ]; then
        echo "status 1 with $(wc -l <"$work/said") lines"
    else
        # a new film may be there already if only the picture fails
        diff -rq "$work/run" "$work/given" |
            grep -v 'film differ$\|/run: .*film$'
        for film in "$work"/run/*film; do
            [ ! -e "$film" ] || cmp -s "$film" "$work/given/${film##*/}" ||
                is_same_film "$film" "$work/good/${film##*/}" ||
                echo "${film##*/} is torn"
        done
    fi
}

# Counts the attempts of a kind of fault and prints a row.
tally() # NAME TRIED BAD ERRORS
{
    if [ "$3" = 0 ] && [ "$2" -gt 0 ]; then
        echo "ok $1: $2 faults, $4 errors"
    else
        echo "FAIL $1: $3 of $2 faults"
        failed=1
    fi
}

# Tries a fault and adds it to tried, bad and errors.
try() # WITH... -- COMMAND...
{
    local problem

    attempt "$@"
    problem=$(wrong)
    tried=$((tried + 1))
    [ "$status" = 0 ] || errors=$((errors + 1))
    [ -z "$problem" ] && return
    bad=$((bad + 1))
    echo "-- $1 $2 $3: $problem"
    sed 's/^/-- /' "$work/said" | head -n 3
}

preload() # FAULT
{
    with=(env "FAULT=$1" "LD_PRELOAD=$build/faults/fault.so")
}

# Lets memory and threads fail.
calls() # NAME COMMAND...
{
    local kind name=$1 total with n tried bad errors stride

    shift
    for kind in memory thread; do
        preload $kind:-1
        attempt "${with[@]}" -- "$@"
        total=$(od -An -t d8 "$FAULT_COUNT" | tr -d ' ')
        tried=0 bad=0 errors=0 stride=$step
        [ $kind = thread ] && stride=1
        for ((n = 1 + total % stride; n <= total; n += stride)); do
            preload $kind:$n
            try "${with[@]}" -- "$@"
        done
        preload $kind:$((total / 2))+
        try "${with[@]}" -- "$@"
        tally "$name, $kind" $tried $bad $errors
    done
}

# Lets system calls fail. strace counts them for each thread.
system_calls() # NAME COMMAND...
{
    local fault name=$1 call n total tried bad errors

    shift
    for fault in openat:EMFILE read:EIO fsync:EIO rename:EIO link:EIO \
        clone3:EAGAIN close:EIO; do
        call=${fault%:*}
        attempt strace -f -qq -o "$work/trace" -e "trace=$call" -- "$@"
        total=$(cut -d ' ' -f 1 "$work/trace" | sort | uniq -c | sort -n |
            awk 'END { print $1 + 0 }')
        tried=0 bad=0 errors=0
        for ((n = 1; n <= total; n += (step + 9) / 10)); do
            try strace -f -qq -o /dev/null -e "trace=$call" \
                -e "inject=$call:error=${fault#*:}:when=$n" -- "$@"
        done
        [ $tried = 0 ] || tally "$name, $call" $tried $bad $errors
    done
}

# Keeps what a command makes as the right result, and lets its calls fail.
check() # NAME COMMAND...
{
    local name=$1

    [[ $name == *"${FILTER-}"* ]] || return
    attempt -- "${@:2}"
    rm -rf "$work/good"
    cp -r "$work/run" "$work/good"
    [ "$status" = 0 ] || tally "$name without a fault" 1 1
    calls "$@"
    if command -v strace >/dev/null; then
        system_calls "$@"
    else
        echo "skip $name, system calls (no strace)"
    fi
}

# Presses keys that move, open windows, save and quit.
press()
{
    local key

    for key in w d e m m v p '+' l n N g g; do
        sleep 0.03
        printf '%s' "$key"
    done
    sleep 0.2
    printf '\021'
}

# Lets memory fail on the screen, which must be left each time that it was
# entered, with a reason behind it if glim fails.
screen()
{
    local n total tried=0 bad=0 errors=0 in out with

    [[ screen == *"${FILTER-}"* ]] || return
    command -v script >/dev/null || {
        echo 'skip screen (no script)'
        return
    }
    for ((n = -1; n <= ${total:-0}; n += n < 1 ? 2 : step)); do
        preload memory:$n
        rm -rf "$work/run" "$work/state" "$FAULT_COUNT"
        mkdir "$work/run"
        press | (cd "$work/run" && timeout 60 script -qec "stty rows 30 cols 100
            TERM=xterm-256color ${with[*]} $glim -w 32 -h 18 -s 4 -t 1 \
            $scenes/cornell.obj" "$work/typescript" >/dev/null 2>&1)
        status=$?
        total=${total:-$(od -An -t d8 "$FAULT_COUNT" | tr -d ' ')}
        in=$(grep -ao '\[?1049h' "$work/typescript" | wc -l)
        out=$(grep -ao '\[?1049l' "$work/typescript" | wc -l)
        tried=$((tried + 1))
        [ $status = 0 ] || errors=$((errors + 1))
        if [ $status -gt 1 ] || [ "$in" != "$out" ] ||
            [ $status = 1 ] && ! grep -aq 'glim: \|Out of memory' \
                "$work/typescript" || ls "$work/run"/*~ >/dev/null 2>&1; then
            bad=$((bad + 1))
            echo "-- memory:$n: status $status, entered $in times, left $out"
        fi
    done
    tally 'screen, memory' $tried $bad $errors
}

# Lets calls of a driver fail. FAULT_DEVICE=other is a device with memory of its
# own.
# shellcheck disable=SC2086 # words
device()
{
    local fault kind n total tried bad errors=0

    [[ opencl == *"${FILTER-}"* ]] || return
    FAULT_OPENCL=$(ldconfig -p | awk '/libOpenCL.so.1 / { print $NF; exit }')
    if [ -z "$FAULT_OPENCL" ] || ! "$glim" --list-devices >/dev/null 2>&1; then
        echo 'skip opencl (no device)'
        return
    fi
    export FAULT_OPENCL
    rm -rf "$work/good" "$work/given"
    mkdir "$work/good" "$work/given"
    "$glim" $small -o "$work/good/out.pfm" "$scenes/cornell.obj" 2>/dev/null
    for kind in '' other; do
        tried=0 bad=0
        try_device opencl:-1 ${kind:+FAULT_DEVICE=$kind}
        total=$(od -An -t d8 "$FAULT_COUNT" | tr -d ' ')
        for ((n = 1; n <= total; n += step)); do
            try_device opencl:$n ${kind:+FAULT_DEVICE=$kind}
            try_device opencl:$n+ ${kind:+FAULT_DEVICE=$kind}
        done
        tally "opencl${kind:+, $kind}" $tried $bad $errors
    done
    tried=0 bad=0
    for fault in clGetPlatformIDs:1 clEnqueueNDRangeKernel:3; do
        try_device $fault FAULT_CODE=hang
    done
    tally 'opencl, hanging' $tried $bad $errors
}

# Renders on the device with a fault: the picture is that of the CPU, with one
# warning at most.
# shellcheck disable=SC2086 # words
try_device() # FAULT VARIABLE...
{
    local problem

    attempt env "FAULT=$1" "LD_LIBRARY_PATH=$build/faults/opencl" "${@:2}" -- \
        "$glim" $small --backend opencl -o out.pfm "$scenes/cornell.obj"
    problem=$(differing "$work/run" "$work/good")
    if [ "$status" != 0 ] || [ "$(grep -vc '^out.pfm' "$work/said")" -gt 1 ]; then
        problem="status $status $problem"
    fi
    tried=$((tried + 1))
    [ -z "$problem" ] && return
    bad=$((bad + 1))
    echo "-- $*: $problem"
    sed 's/^/-- /' "$work/said" | head -n 3
}

# shellcheck disable=SC2086 # words
pictures()
{
    mkdir "$work/given"
    check cornell "$glim" $small -o out.png "$scenes/cornell.obj"
    check skylit "$glim" $small --denoise -o out.exr "$scenes/skylit.obj"
    check globe "$glim" $small -o out.png "$scenes/globe.obj"
    check bottles "$glim" $small -o out.hdr "$scenes/bottles.glb"
    check film "$glim" $small -o out.png --film a.film "$scenes/cornell.obj"
    "$glim" $small -o "$work/x.png" --film "$work/given/a.film" \
        "$scenes/cornell.obj" 2>/dev/null
    check resume "$glim" $small --resume a.film --film a.film -o out.png \
        "$scenes/cornell.obj"
    check develop "$glim" develop a.film -o out.png
}

pictures
screen
device
exit $failed
