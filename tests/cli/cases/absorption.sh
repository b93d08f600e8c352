# SPDX-License-Identifier: MIT
# Statements about the inside of glass that have no meaning are named, and the
# picture is made; a word in place of a number is an error.
printf 'mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nusemtl m\nf 1 2 3\n' >a.obj
try() # STATEMENTS
{
    printf "newmtl m\nKe 1\n$1" >a.mtl
    run_untimed -b -w 8 -h 8 -s 1 -o a.pfm a.obj
}
try 'illum 7\nTf .5\nTf_distance 2\n'
try 'illum 7\nTf .5\nTf_distance -2\n'
try 'illum 7\nTf .5\nTf_distance far\n'
try 'Kd .5\nTf_distance 2\n'
try 'illum 4\nTf .5\nTf_distance 2\n'
try 'Kd .5\nPr .5\nTf .5\nTf_thin 2\n'
try 'Kd .5\nPr .5\nmap_Pcr none.png\n'
try 'Kd .5\nTf_scatter 1\nTf_absorb 2\n'
try 'illum 7\nTf_scatter 1 2 3\nTf_absorb .1\nTf_anisotropy .5\n'
try 'illum 7\nNi 1\nTf_scatter 1\nTf_distance 2\n'
try 'illum 7\nTf .5\nTf_distance 2\nTf_multiscatter .8\nTf_anisotropy 1\n'
try 'illum 7\nTf_scatter 1 -1 1\n'
try 'illum 7\nTf_scatter 1\nTf_anisotropy 1.5\n'
try 'illum 7\nTf_scatter much\n'
try 'illum 7\nTf_absorb 1 2\n'
