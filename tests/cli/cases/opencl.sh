# SPDX-License-Identifier: MIT
# Batch mode on an OpenCL device gives the CPU's bytes. If there is none or it
# fails, a message says so, and the CPU renders.
cp /etc/OpenCL/vendors/pocl.icd . 2>/dev/null || skip "no PoCL here"
export OCL_ICD_VENDORS=$PWD
take box

# Removes the device's name, which is that of the processor.
device()
{
    run_untimed -b --backend opencl "$@" |
        sed 's/on [^:]*: the ker/on D: the ker/; s/device [^:]*:/device D:/
            s/Device [^:]* failed/Device D failed/'
}

for options in "" "-d 2 --seed 9" "--crop 7,3,30,20 -s 20" "-w 61 -h 1"; do
    device -t 2 -w 64 -h 48 -s 5 $options -o device.pfm box.obj
    glim -b -t 1 -w 64 -h 48 -s 5 $options -o cpu.pfm box.obj 2>/dev/null
    same device.pfm cpu.pfm
done
glim -b --device 1 -w 8 -h 8 -s 1 -o a.png --stats - box.obj 2>/dev/null |
    sed -n '/backend/p; /device/s/"pthread.*/".../p; /driver/s/: ".*/: .../p'

echo '- a signal saves the picture so far'
timeout --preserve-status -s TERM 2 glim -b --backend opencl -w 40 -h 30 \
    -s 1000000000 -o out.png box.obj 2>err
echo "exit $?"
sed 's/ at [0-9]* of/ at N of/' err | untimed
kind out.png

echo '- no driver'
OCL_ICD_VENDORS=/nonexistent device -w 8 -h 8 -s 1 -o a.png box.obj
OCL_ICD_VENDORS=/nonexistent run_untimed -b --backend auto -w 8 -h 8 -s 1 \
    -o a.png box.obj
run_untimed -b --device 7 -w 8 -h 8 -s 1 -o a.png box.obj |
    sed "s/ of 1 '.*'/ of 1 '...'/"
run_untimed -b --device nosuch -w 8 -h 8 -s 1 -o a.png box.obj |
    sed "s/ of 1 '.*'/ of 1 '...'/"
OCL_ICD_VENDORS=/nonexistent run_untimed -b --device 1 -w 8 -h 8 -s 1 \
    -o a.png box.obj

echo '- no linker for what is not compiled yet'
(
    export POCL_CACHE_DIR=$PWD/cold
    mkdir bin
    ln -s "$(command -v glim)" bin/glim
    PATH=$PWD/bin glim -b --backend opencl -w 8 -h 8 -s 1 -o a.png box.obj 2>err
    echo "exit $?"
    grep -c 'unable to execute' err
    grep 'warning' err | sed 's/kernel [a-z_]*/kernel K/'
)

echo '- a cache that is no folder'
: >file
POCL_CACHE_DIR=$PWD/file device -w 8 -h 8 -s 1 -o a.png box.obj |
    sed "s|$PWD|PWD|"

echo '- kernels from a folder, whole and broken'
cp -r "$root/kernels" kernels
device --kernels kernels -w 64 -h 48 -s 5 -o device.pfm box.obj
glim -b -w 64 -h 48 -s 5 -o cpu.pfm box.obj 2>/dev/null
same device.pfm cpu.pfm
sed -i '0,/^{$/s//{ oops;/' kernels/path.h
device --kernels kernels -w 8 -h 8 -s 1 -o a.png box.obj >err
grep -c "^error: kernels/path.h:[0-9]*:[0-9]*: use of undeclared identifier 'oops'" err
tail -n 3 err | sed 's/path.h:[0-9:]*/path.h:N/; s/^[0-9]* error/N error/'
device --kernels nowhere -w 8 -h 8 -s 1 -o a.png box.obj

echo '- a device with too little memory'
POCL_MEMORY_LIMIT=1 device -w 2400 -h 2400 -s 1 -d 0 -o a.pfm box.obj
