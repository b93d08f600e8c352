# SPDX-License-Identifier: MIT
# PNG and HDR files carry the name of the scene, seed and samples; the same
# render has the same bytes from any folder and with any number of threads.
take box
mkdir below
cp box.* below
b="-b -w 9 -h 5 -s 3 --seed 7"
run_untimed $b -t 1 -o a.png box.obj
run_untimed $b -t 2 -o b.png "$PWD/below/box.obj"
run_untimed $b -t 2 --stats run.json -o c.png box.obj
same a.png b.png
same a.png c.png
head -c 256 a.png | LC_ALL=C tr '\0' '=' |
    LC_ALL=C grep -a -o -e 'Software=glim' -e 'glim:scene=box.obj' \
        -e 'glim:seed=7' -e 'glim:spp=3'
run_untimed $b -o a.hdr box.obj
head -n 5 a.hdr | sed 's/glim [0-9.]*$/glim N/'
