# SPDX-License-Identifier: MIT
# The panel while files of the scene change: what is edited and not saved is not
# thrown away, what glim has written itself is no change, and a pick of the scene
# before is gone; the window about the render and the panel take each other's place.
lamp_scene
printf 'newmtl l\nKd 0 0 0\nKe 1 1 1\n' >lamp.mtl
size=100x24
start --watch lamp.obj
wait_for LIVE
keys Tab Enter
wait_for "│>...."
keys Down Down Down Down Down Down Down Down Down Down Down
wait_for "│>....of colour  #ffffff"
raw_keys '#ff0000'
keys Enter
wait_for " l \*"
printf 'newmtl l\nKd 0 0 0\nKe 1 1 1\nNs 7\n' >lamp.mtl
wait_for "changed: l loads"
keys l
wait_for "not loaded: changes of materials or light are not saved"
keys C-s # both changes, and then they are loaded
wait_for "loaded lamp.obj"
grep -q '^Ns 7$' lamp.mtl || die "lamp.mtl: $(cat lamp.mtl)"
grep -q '^Ke 1 0 0$' lamp.mtl || die "lamp.mtl: $(cat lamp.mtl)"
wait_for "LIVE .*spp"
reject "changed"
# the same is selected, and what is being typed goes on
expect "│>....of colour  #ff0000"
raw_keys '#00'
wait_for "│>....of colour  #00_"
printf 'newmtl first\nKd 1 1 1\nnewmtl l\nKd 0 0 0\nKe 1 0 0\n' >lamp.mtl
wait_for "loaded lamp.obj"
wait_for "│>....of colour  #00_"
expect "│─ l ─"
# saved by ourselves
raw_keys 'ff00'
keys Enter
wait_for "│>....of colour  #00ff00"
keys C-s
wait_for "wrote 1 material to lamp.mtl"
wait_until_gone "wrote 1 material" # a load would say so in its place
reject "changed\|loaded"
# the window about the render is not beside the panel
keys g
wait_for "┌─ about this render ─"
reject "Materials"
keys Tab
wait_for "Materials"
reject "about this"
# what was picked is of the scene before
keys Escape
wait_until_gone "Materials"
keys v Enter
wait_for "orbit, "
printf 'newmtl l\nKd 0 0 0\nKe 1 1 1\n' >lamp.mtl
wait_for "loaded lamp.obj"
keys f
wait_for "nothing is picked"
keys C-q
expect_end 0
