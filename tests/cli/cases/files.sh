# SPDX-License-Identifier: MIT
# Scenes that cannot be read cause one line with the place, and status 1.
b="-b -w 8 -h 4 -s 1 -o out.png"
run $b missing.obj
mkdir folder.obj
run $b folder.obj
: >empty.obj
run $b empty.obj
head -c 3000 "$(command -v glim)" >binary.obj
run $b binary.obj
for word in root daemon bin sys games man lp mail news uucp proxy www backup \
    list irc gnats nobody apt systemd messagebus sshd tss dnsmasq; do
    printf '%s:x:1:1:a user:/:/bin/sh\n' "$word"
done >passwd.obj
run $b passwd.obj
printf 'a text\nwith lines\ns of\nwhich one could be in OBJ\n' >text.obj
run $b text.obj
printf 'v 0 0 0\nv 1 x 0\n' >number.obj
run $b number.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >fine.obj
run $b -c missing.view fine.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n' >index.obj
run_untimed $b index.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf -18446744073709551617 2 3\n' >index.obj
run_untimed $b index.obj
rm -f out.png
ls
