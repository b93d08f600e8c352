# SPDX-License-Identifier: MIT
# Materials as Blender writes them, with and without its extension, and in glim's
# own statements, give the same picture; a message names the version.
face='v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n'
gold='Ni 1.500000\nd 1.000000\nillum 3\n'
colors='Kd 1.000000 0.700000 0.200000\nKs 0.500000 0.500000 0.500000\n'
colors="${colors}Ke 0.000000 0.000000 0.000000\n"
picture() # NAME STATEMENTS
{
    printf "$2" >$1.mtl
    printf "mtllib $1.mtl\nusemtl m\n$face" >$1.obj
    run_untimed -b -w 8 -h 8 -s 4 -o $1.pfm $1.obj
    cmp first.pfm $1.pfm
}
picture first 'newmtl m\nKd 1 .7 .2\nPm 1\nPr .2\n'
picture classic "# Blender 5.0.1 MTL File: 'None'\n# www.blender.org\n
newmtl m\nNs 640.000000\nKa 1.000000 1.000000 1.000000\n$colors$gold"
picture lost "newmtl m\nNs 640.000000\nKa 1.000000 1.000000 1.000000\n$colors$gold"
picture extended "# Blender 3.4.1 MTL File: 'None'\n
newmtl m\n$colors${gold}Pr 0.200000\nPm 1.000000\nPs 0.000000\naniso 0.000000\n"
# a number that is none, in a statement that only these files use
printf '# Blender 4.0.0 MTL File\nnewmtl m\nKa x\n' >lost.mtl
run_untimed -b -w 8 -h 8 -s 4 -o lost.pfm lost.obj
