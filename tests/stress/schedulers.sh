#!/bin/bash
# SPDX-License-Identifier: MIT
# schedulers.sh - runs the recipes of docs/cluster.md for GNU parallel and Slurm
#
# usage: schedulers.sh GLIM FOLDER SCENE
#
# The recipes are taken from the text, with smaller numbers. Slurm runs on this
# machine alone, with files of its own in the folder; one task of its array is
# stopped and started again. The pictures have the bytes of a single process.
# Prints a row for each recipe.
set -u
glim=$1
folder=$2
scene=$3
mpi=$(dirname "$glim")/mpi/glim
recipes=$PWD/docs/cluster.md
export PATH=${glim%/*}:$PATH
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
size='-w 120 -h 90'
pids=

cleanup()
{
    # shellcheck disable=SC2086 # words
    [ -z "$pids" ] || kill $pids
    wait
} 2>/dev/null
trap cleanup EXIT

# Prints the lines of the recipe that begins with this text.
recipe()
{
    awk -v begin="    $1" 'index($0, begin) == 1 { is_in = 1 }
        is_in && !/^    / { exit }
        is_in { print substr($0, 5) }' "$recipes"
}

# Compares the picture with that of a single process.
row() # NAME
{
    if cmp -s out.png whole.png; then
        echo "ok $1"
    else
        echo "FAIL $1"
        tail -n 3 said
    fi
    rm -f ./*.film out.png
}

# GNU parallel, on this machine without ssh.
parallel_recipe()
{
    command -v parallel >/dev/null || { echo "skip GNU parallel (no parallel)"; return; }
    echo : >hosts
    recipe 'parallel --sshloginfile' | sed "s/-s 4096/-s 64 $size/" >job.sh
    bash job.sh >said 2>&1
    glim merge -o out.png [0-9]*.film >>said 2>&1
    row 'GNU parallel'
}

# Starts a Slurm of this machine. Returns false if it does not get ready.
start_slurm()
{
    mkdir state spool
    cat >slurm.conf <<END
ClusterName=one
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/none
CredType=cred/none
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
SlurmctldPidFile=$PWD/slurmctld.pid
SlurmdPidFile=$PWD/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
NodeName=$(hostname) NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
    export SLURM_CONF=$PWD/slurm.conf
    slurmctld -D >slurmctld.log 2>&1 &
    pids=$!
    slurmd -D >slurmd.log 2>&1 &
    pids="$pids $!"
    for _ in $(seq 60); do
        sinfo -h -o %T 2>/dev/null | grep -q idle && return
        sleep 0.5
    done
    return 1
}

# Waits until the command succeeds, for a minute.
wait_until()
{
    for _ in $(seq 600); do
        "$@" && return
        sleep 0.1
    done
    echo "waited for: $*" >>said
}

is_queue_empty()
{
    [ -z "$(squeue -h)" ]
}

is_requeued()
{
    squeue -h -r -o '%F_%K %T' | grep -q "$1 PENDING"
}

slurm_array()
{
    local array

    recipe '#!/bin/sh' | sed "s/1-64/1-4/; s|/64|/4|; s/=8/=1/; s/-t 8/-t 1/
        s/65536/2000 $size --checkpoint-interval 0.1/" >job.sh
    array=$(sbatch --parsable job.sh)
    wait_until test -f 1.film
    scontrol requeue "${array}_1"
    wait_until is_requeued "${array}_1"
    # it would wait for two minutes
    scontrol update "jobid=${array}_1" StartTime=now
    wait_until is_queue_empty
    cat slurm-*.out >said
    glim merge -o out.png [0-9]*.film >>said 2>&1
    scontrol show job "${array}_1" | grep -q 'Restarts=1' || rm -f out.png
    row 'Slurm, a job array, one task stopped and started again'
}

slurm_mpi()
{
    [ -x "$mpi" ] || { echo "skip srun (no program with MPI)"; return; }
    recipe 'mpirun -n 8' | sed -n "s/-n 8/-n 2/; s/-s 4096/-s 2000 $size -t 1/
        s/scene.png/out.png --stats ranks.json/; s/^srun/timeout 300 &/p" |
        sed "s|glim|$mpi|" >job.sh
    bash job.sh >said 2>&1
    [ "$(grep -c '"answers": [1-9]' ranks.json)" = 2 ] || rm -f out.png
    row 'Slurm, srun with two ranks'
}

slurm_recipes()
{
    local program

    for program in slurmctld slurmd sbatch; do
        command -v $program >/dev/null ||
            { echo "skip Slurm (no $program)"; return; }
    done
    if ! start_slurm; then
        echo "skip Slurm (it does not start: $(grep -h -i error slurm*.log |
            tail -n 1))"
        return
    fi
    # shellcheck disable=SC2086 # words
    "$glim" -b -s 2000 $size -o whole.png scene.obj 2>said
    slurm_array
    slurm_mpi
}

cp "${scene%.obj}".* "$folder"
cd "$folder" || exit 2
for file in "$(basename "$scene" .obj)".*; do
    case $file in
    *.obj | *.view) mv "$file" "scene.${file##*.}" ;;
    esac
done
# shellcheck disable=SC2086 # words
"$glim" -b -s 64 $size -o whole.png scene.obj 2>said
parallel_recipe
slurm_recipes
