# SPDX-License-Identifier: MIT
# b starts an OpenCL device while the CPU renders, and returns to the CPU;
# without a device the CPU continues, and a message gives the reason.
cp /etc/OpenCL/vendors/pocl.icd . 2>/dev/null || {
    echo "no PoCL here"
    exit 77
}
export OCL_ICD_VENDORS=$PWD
flat_scene
size=160x21
device_is_there() # and takes its message away
{
    wait_for "renders; self-test: the CPU's bits"
    keys Escape
    wait_until_gone "renders; self-test"
    wait_for "LIVE  OpenCL "
}
start -t 1 flat.obj
wait_for "LIVE .* spp"
reject "OpenCL"
keys b
device_is_there
wait_for_rows 20 "48;2;188;124;0"
sees_nothing() # a move says it again, if it was missed
{
    has_line "nothing of the scene is in view" || {
        keys w
        return 1
    }
}
wait_until sees_nothing
keys Escape
wait_until_gone "nothing of the scene"
wait_for "LIVE  OpenCL .* [1-9][0-9]* spp"
wait_for_rows 20 "48;2;188;124;0"
keys b
wait_for "the CPU renders"
keys Escape
wait_until_gone "the CPU renders"
wait_for "LIVE .* spp"
reject "OpenCL"
keys b
device_is_there
keys Space b
wait_for "the backend changes only in live mode"
keys C-q
expect_end 0
fresh
start --backend opencl -s 3 flat.obj
device_is_there
keys Space Enter
wait_for "NORMAL done  OpenCL  3/3 spp"
keys p
wait_for "saved flat.png 100x50, 3 spp"
keys C-q
expect_end 0
fresh
start_line "OCL_ICD_VENDORS=/nonexistent TERM=tmux-256color glim --device 1 flat.obj"
wait_for "OpenCL: found no platform"
wait_for_rows 20 "48;2;188;124;0"
keys '~'
wait_for "LIVE"
keys C-q
expect_end 0
# one that is not there
fresh
start --device nosuch flat.obj
wait_for "found no device 'nosuch', expected one of 1 'pthread"
wait_for_rows 20 "48;2;188;124;0"
keys C-q
expect_end 0
# closed while the device is on its way
fresh
start -t 1 --backend opencl flat.obj
wait_for "LIVE"
keys C-q
expect_end 0
# picks after a reload of another shape
fresh
lamp_scene
start -t 1 --backend opencl lamp.obj
device_is_there
sed -i 's/^v 0 1 0/v 0 2 0/' lamp.obj
wait_for "changed: l loads"
keys l
wait_for "loaded lamp.obj"
keys v
wait_for "face 1, 5[0-9.]* away"
keys C-q
expect_end 0
