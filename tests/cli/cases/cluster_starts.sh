# SPDX-License-Identifier: MIT
# Ranks start with what their program has, and end with it; a job that was killed
# goes on.
mpi_program
take box
b="-b -w 48 -h 36 -t 1"

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
