# SPDX-License-Identifier: MIT
# A device that fails, or a driver that does not answer any more: the CPU goes on,
# and takes keys.
folder=$(dirname "$(command -v glim)")/faults/opencl
FAULT_OPENCL=$(ldconfig -p | awk '/libOpenCL.so.1 / { print $NF; exit }')
if [ ! -e "$folder" ] || [ -z "$FAULT_OPENCL" ] ||
    ! glim --list-devices >/dev/null 2>&1; then
    echo 'no device to fail, or sanitizers'
    exit 77
fi
export FAULT_OPENCL
flat_scene
size=160x21
begin() # VARIABLE... OPTION...
{
    start_line "LD_LIBRARY_PATH=$folder TERM=tmux-256color $*"
    wait_for "renders; self-test: the CPU's bits"
}
# the self-test has fewer calls than these
begin FAULT=clEnqueueNDRangeKernel:2000+ glim --backend opencl flat.obj
wait_for "clEnqueueNDRangeKernel: CL_OUT_OF_RESOURCES; the CPU renders"
keys Escape
wait_for "LIVE .* [1-9][0-9]* spp"
reject "OpenCL"
keys C-q
expect_end 0
fresh
begin FAULT=clEnqueueNDRangeKernel:2000 FAULT_CODE=hang glim --backend opencl \
    flat.obj
moves_until_said() # a halt waits less long than a pass
{
    has_line "OpenCL: the driver does not answer; the CPU renders" || {
        keys w
        return 1
    }
}
wait_until moves_until_said
keys Escape
wait_for "LIVE .* [1-9][0-9]* spp"
reject "OpenCL"
keys C-q
expect_end 0
