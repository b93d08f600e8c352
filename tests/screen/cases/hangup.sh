# SPDX-License-Identifier: MIT
# The window is closed: the program ends by itself.
flat_scene
start flat.obj
wait_for "LIVE .* spp"
pid=$(program_pid)
mux kill-session
gone()
{
    ! kill -0 "$pid" 2>/dev/null
}
wait_until gone
