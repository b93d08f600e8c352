# SPDX-License-Identifier: MIT
# The ending selects the format; -o replaces; without -o files are numbered.
take box
b="-b -w 9 -h 5 -s 1"
for name in out.png out.hdr out.pfm; do
    echo old >$name
    run_untimed $b -o $name box.obj
    kind $name
done
glim $b -o - box.obj >piped.png 2>err
echo "exit $?"
untimed err
same out.png piped.png
mkdir elsewhere
cd elsewhere
run_untimed $b ../box.obj
run_untimed $b ../box.obj
run_untimed $b ../box.obj
ls
same box.png ../out.png
same box-3.png ../out.png
