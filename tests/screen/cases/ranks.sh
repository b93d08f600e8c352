# SPDX-License-Identifier: MIT
# The window about the render shows each rank of a cluster. One that is stopped is
# late, goes on, and is no longer.
mpi=${BUILD:-build/release}/mpi/glim
case $mpi in
/*) ;;
*) mpi=$root/$mpi ;;
esac
if ! command -v mpirun >/dev/null || [ ! -x "$mpi" ]; then
    echo "no program with MPI"
    exit 77
fi
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
lamp_scene
size=80x24
start_line "TERM=tmux-256color '$mpi' --ranks 2 -t 3 lamp.obj"
wait_for "LIVE .* spp"
keys g
wait_for "2 ranks  "
wait_for "rank 0  *[0-9.]* [kMG] .* [kMG]/s"
wait_for "rank 1  *[0-9.]* [kMG] .* [kMG]/s"
wait_for "[4-9] s of rendering"
worker=$(pgrep -f -- "$mpi --worker.* -t 3")
kill -STOP "$worker"
wait_for "2 ranks  *1 late"
wait_for "rank 1 .* late [0-9]* s"
kill -CONT "$worker"
wait_for "rank 1  *[0-9.]* [kMG] .* [kMG]/s"
keys C-q
expect_end 0
