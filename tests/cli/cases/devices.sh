# SPDX-License-Identifier: MIT
# The list of PoCL's devices, and the messages without a device.
mkdir vendors
cp /etc/OpenCL/vendors/pocl.icd vendors 2>/dev/null || skip "no PoCL here"
export OCL_ICD_VENDORS=$PWD/vendors
unset POCL_DEVICES POCL_MAX_PTHREAD_COUNT POCL_CPU_MAX_CU_COUNT XDG_CACHE_HOME

# Removes what depends on the machine: memory, versions, the processor's name.
plain()
{
    sed 's/  */ /g; s/ [0-9.]* GiB/ M GiB/; s/OpenCL [0-9.]* .* \(Port\)/V \1/'
}
glim -t 1 --list-devices | plain
run --list-devices -t 3 nothing.obj | plain
POCL_MAX_PTHREAD_COUNT=2 POCL_CPU_MAX_CU_COUNT=2 glim -t 3 --list-devices |
    plain

echo '- no driver, no device'
OCL_ICD_VENDORS=/nonexistent run --list-devices
POCL_DEVICES=nonsense run --list-devices

echo '- no cache folder'
: >file
POCL_CACHE_DIR=file/sub run --list-devices
unset POCL_CACHE_DIR
HOME=$PWD/file run --list-devices | sed "s|$PWD|PWD|"

echo '- folders are made, and their names may have any characters'
XDG_CACHE_HOME="$PWD/a b/it's" glim --list-devices >list && find a*
XDG_CACHE_HOME=relative HOME=$PWD/home glim --list-devices >list && find home
ls

echo '- what is no library'
mkdir library
: >library/libOpenCL.so.1
LD_LIBRARY_PATH=$PWD/library run --list-devices | sed "s|$PWD|PWD|"
if echo 'int clGetPlatformIDs(void);
         int clGetPlatformIDs(void) { return 0; }' |
    cc -shared -fPIC -x c -o library/libOpenCL.so.1 - 2>/dev/null; then
    LD_LIBRARY_PATH=$PWD/library run --list-devices
fi
if [ -e /dev/full ]; then
    glim --list-devices 2>&1 >/dev/full
    echo "exit $?"
fi
