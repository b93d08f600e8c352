# SPDX-License-Identifier: MIT
# Thousands of faces or of instances in one place take the time of one, those in
# a row and thousands of materials a moment.
{
    echo 'v 0 0 0'
    echo 'v 1 0 0'
    echo 'v 0 1 0'
    yes 'f 1 2 3' | head -n 10000
} >faces.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >face.obj

# A mesh of 2 n n triangles in so many nodes, this far from each other.
gltf() # nodes n file distance
{
    awk -v count="$1" -v n="$2" -v step="${4-0}" 'BEGIN {
        printf "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0"
        for (i = 1; i < count; i++)
            printf ",%d", i
        printf "]}],\"nodes\":[{\"mesh\":0}"
        for (i = 1; i < count; i++)
            printf ",{\"mesh\":0,\"translation\":[%g,0,0]}", step * i
        vertices = (n + 1) * (n + 1)
        printf "],\"meshes\":[{\"primitives\":[{\"attributes\":"
        printf "{\"POSITION\":0},\"indices\":1}]}],\"accessors\":["
        printf "{\"bufferView\":0,\"componentType\":5126,\"count\":%d,", vertices
        printf "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[2,2,0]},"
        printf "{\"bufferView\":1,\"componentType\":5123,\"count\":%d,", 6 * n * n
        printf "\"type\":\"SCALAR\"}],\"bufferViews\":["
        printf "{\"buffer\":0,\"byteLength\":%d},", 12 * vertices
        printf "{\"buffer\":0,\"byteOffset\":%d,", 12 * vertices
        printf "\"byteLength\":%d}],\"buffers\":[", 12 * n * n
        printf "{\"uri\":\"mesh.bin\",\"byteLength\":%d}]}", 12 * vertices + 12 * n * n
    }' >"$3.gltf"
}
# Floats of k / 64 for k from 64 to 127: 0x3f80 + 2 (k - 64) in the high bytes.
awk -v n=60 'BEGIN {
    for (i = 0; i <= n; i++)
        for (k = 0; k <= n; k++)
            printf "\\000\\000\\%03o\\077\\000\\000\\%03o\\077\\000\\000\\000\\000", 128 + 2 * i, 128 + 2 * k
    for (i = 0; i < n; i++)
        for (k = 0; k < n; k++) {
            a = i * (n + 1) + k
            split(a " " (a + n + 1) " " (a + 1) " " (a + 1) " " (a + n + 1) " " (a + n + 2), v, " ")
            for (j = 1; j <= 6; j++)
                printf "\\%03o\\%03o", v[j] % 256, v[j] / 256
        }
}' >octal
printf "$(cat octal)" >mesh.bin
gltf 100000 60 many
gltf 1 60 one
gltf 100000 60 row 3
gltf 20000 60 pile .0001
printf 'background 0 0 0\nlight point 0 0 9\n' >row.view
echo 'background .5 .6 .7' >pile.view

# Materials whose names begin alike
awk 'BEGIN {
    name = sprintf("%100s", "")
    printf "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}"
    for (i = 0; i < 40000; i++)
        printf ",{\"name\":\"%s%d\"}", name, i
    printf "],"
}' >materials.gltf
tail -c +28 one.gltf >>materials.gltf

# Processor time, unless a sanitizer takes more.
limit_memory 8000000 && ulimit -t 8
for pair in 'face.obj faces.obj' 'one.gltf many.gltf'; do
    for file in $pair; do
        glim -b -t 1 -w 24 -h 18 -s 4 -o "$file.pfm" "$file" 2>/dev/null
        echo "$file: exit $?"
    done
    set -- $pair
    same "$1.pfm" "$2.pfm"
done
for file in row.gltf pile.gltf materials.gltf; do
    glim -b -t 1 -w 4 -h 3 -s 1 -o "$file.pfm" "$file" 2>/dev/null
    echo "$file: exit $?"
done
