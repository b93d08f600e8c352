# SPDX-License-Identifier: MIT
# Statements about sheen, films, coverage and translucency that are out of range
# are named, and the picture is made; a word in place of a number is an error.
printf 'mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nusemtl m\nf 1 2 3\n' >a.obj
try() # STATEMENTS
{
    printf "newmtl m\nKe 1\n$1" >a.mtl
    run_untimed -b -w 8 -h 8 -s 1 -o a.pfm a.obj
}
try 'Pm 1\nPf 1\nPf_ior 1.4\nPf_thickness 300\nPs .5\nPs_roughness .3\n'
try 'Pm 1\nPf 2\n'
try 'Pm 1\nPf 1\nPf_ior .9\n'
try 'Pm 1\nPf 1\nPf_thickness 2001\n'
try 'Pm 1\nPf 1\nPf_thickness thick\n'
try 'Ps .5\nPs_roughness -1\n'
try 'd .5\nd_cutoff 1.5\n'
try 'd .5\nd_cutoff half\n'
try 'Td .5\nTd_weight 2\n'
try 'Td_weight half\n'
try 'Pm 1\nTd .5\n'
