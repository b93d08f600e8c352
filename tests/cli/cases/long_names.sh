# SPDX-License-Identifier: MIT
# Names too long for a file cause one line each and use little memory and stack.
b="-b -w 8 -h 8 -s 1 -t 1 -o out.png"
ulimit -s 1024
limit_memory 400000 || true
slashes=$(printf '%60000s' '' | tr ' ' /)
folders=$(printf '%30000s' '' | sed 's| |a/|g')
triangle='v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n'
for name in "x${slashes}b" "${folders}b" "${folders}b $slashes"; do
    printf "mtllib %s\n$triangle" "$name" >long.obj
    run_untimed $b long.obj
done
printf "mtllib long.mtl\n$triangle" >map.obj
printf 'newmtl m\nKe 1 1 1\nmap_Kd %sb.png\n' "$folders" >long.mtl
run_untimed $b map.obj
printf 'newmtl m\nKe 1 1 1\n' >long.mtl
printf 'sky %sb.hdr\n' "$folders" >long.view
run $b -c long.view map.obj
run $b "${folders}b.obj"
run $b -o "${folders}b.png" map.obj
run $b --stats "${folders}b" map.obj
run $b -c "${folders}b" map.obj
XDG_CONFIG_HOME="/$folders" run_untimed $b map.obj
# names in another letter case, as deep as possible
mkdir -p Deep/deep
printf 'newmtl m\nKe 1 1 1\n' >Deep/deep/A.mtl
printf "mtllib dEEP//DEEP/./../deep/a.MTL\n$triangle" >case.obj
run_untimed $b case.obj
