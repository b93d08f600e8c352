# SPDX-License-Identifier: MIT
# PLY and STL files: by their bytes or their names, packed, from standard input,
# with an MTL file of their own; messages for wrong ones.
run --formats
b="-b -w 16 -h 9 -s 2"
cat >model.ply <<'END'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
4 0 0
0 3 0
0 0 2
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
END
run_untimed $b -o ply.pfm model.ply
# the name does not matter if the bytes tell the format
cp model.ply model.obj
glim $b -o other.pfm model.obj 2>/dev/null
same ply.pfm other.pfm
glim $b -o other.pfm - <model.ply 2>/dev/null
same ply.pfm other.pfm
gzip -c model.ply >packed.ply.gz
glim $b -o other.pfm packed.ply.gz 2>/dev/null
same ply.pfm other.pfm
# the same triangles with z up, as STL files have it
awk '/^[034]/ && NF == 3 { v[n++] = $1 " " (0 - $3) " " $2; next }
    BEGIN { print "solid s" }
    /^3/ {
        print "facet normal 0 0 0\nouter loop"
        for (i = 2; i < 5; i++)
            print "vertex " v[$i]
        print "endloop\nendfacet"
    }
    END { print "endsolid s" }' model.ply >model.stl
glim $b -o stl.pfm model.stl 2>/dev/null
same ply.pfm stl.pfm
glim $b --up y -o other.pfm model.stl 2>/dev/null
same stl.pfm other.pfm
glim $b --up z -o other.pfm model.ply 2>/dev/null
same ply.pfm other.pfm
# the material, and errors in it
echo 'newmtl clay
Kd 0.2 0.2 0.2' >model.ply.mtl
glim $b -o other.pfm model.ply 2>/dev/null
same ply.pfm other.pfm
echo 'newmtl clay
Kd red' >model.ply.mtl
run $b -o other.pfm model.ply
rm model.ply.mtl
# a message names the file that there is, not the MTL file that saves would make
sed 's/^element v/comment TextureFile none.png\n&/' model.ply >image.ply
run_untimed $b -o other.pfm image.ply
# wrong files
sed 's/^3 1 2 3/3 1 2 4/' model.ply >index.ply
run $b index.ply
sed 's/vertex 4$/vertex 4000000000/' model.ply >many.ply
run $b many.ply
sed 's/face 4$/face 0/' model.ply >points.ply
run $b points.ply
head -n 12 model.ply >short.ply
run $b short.ply
printf 'no\n' >no.ply
run $b no.ply
printf 'no\n' >no.stl
run $b no.stl
head -n 5 model.stl >short.stl
run $b short.stl
head -c 84 /dev/zero >nothing.stl
run_untimed $b -o other.pfm nothing.stl
run --formats=1
