# SPDX-License-Identifier: MIT
# The bytes of a scene with instances do not depend on threads, instructions and
# shares.
forest=$root/scenes/forest.glb
b="-b -w 32 -h 24 -s 4"
glim $b -t 1 --stats s.json -o whole.png "$forest" 2>/dev/null
grep -c '"instances": [1-9]' s.json
for threads in 2 4; do
    glim $b -t $threads --isa plain -o $threads.png "$forest" 2>/dev/null
    same $threads.png whole.png
done
for i in 1 2; do
    glim $b --share $i/2 --film $i.film -o x.png "$forest" 2>/dev/null
done
run_untimed merge -o merged.png 2.film 1.film
same merged.png whole.png
