# SPDX-License-Identifier: MIT
# What a small glTF file can multiply costs a line or little memory: buffers of
# one file, names, instances, weights, packed views.
b="-b -w 8 -h 8 -s 1 -t 1 -o out.png"
# one thread, since threads use part of the limited memory
export MALLOC_ARENA_MAX=1
ulimit -s 1024
limit_memory 1000000 || skip "the sanitizers' own memory is beyond any limit"

# Repeats $2 with commas between, $1 times; @ is the number. (Old versions of
# mawk take the square of the time for it.)
list()
{
    seq 0 $(($1 - 1)) |
        sed "s~.*~$(printf '%s' "$2" | tr '\n@' ' &')~" | paste -s -d , -
}

# A triangle, with further buffers, accessors, views and other members of the
# root. Its bytes are those of the file tri.
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200?\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200?\0\0\0\0' >tri
gltf() # FILE NODES [MESH] [BUFFERS] [ACCESSORS] [VIEWS] [MEMBERS] [PRIMITIVES]
{
    cat >"$1" <<END
{"asset": {"version": "2.0"}, "nodes": [$2],
 "buffers": [{"uri": "tri", "byteLength": 36}${4-}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}${6-}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
  "type": "VEC3"}${5-}],
 "meshes": [{"primitives": [${8-"{\"attributes\": {\"POSITION\": 0}}"}]${3-}}]
 ${7-}}
END
}

# 64 buffers of one file of 60 MB, and other words for it
truncate -s 60M big.bin
ln big.bin link.bin
gltf buffers.gltf '{"mesh": 0}' '' ",$(list 64 '{"uri": "big.bin",
 "byteLength": 1}'),{\"uri\": \"./%62ig.bin\", \"byteLength\": 1},
 {\"uri\": \"link.bin\", \"byteLength\": 1}"
run_untimed $b buffers.gltf

# the name of a mesh and of a camera in 3,000 nodes; the last are named
name=$(printf '%200000s' '' | tr ' ' n)
gltf names.gltf "$(list 3000 '{"mesh": 0, "camera": 0,
 "translation": [@, 0, 0]}'),{\"mesh\": 0, \"name\": \"last\"}" \
    ", \"name\": \"$name\"" '' '' '' ", \"cameras\": [{\"type\": \"perspective\",
  \"perspective\": {\"yfov\": 1, \"znear\": 1}, \"name\": \"$name\"}]"
run_untimed $b names.gltf

# 65,000 instances without data in each of 400 nodes, and their weights
zeros=', {"componentType": 5126, "count": 65000, "type": "VEC3"}'
gltf instances.gltf "$(list 400 '{"mesh": 0, "extensions":
 {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}')" \
    '' '' "$zeros"
run $b instances.gltf
numbers=', {"componentType": 5126, "count": 1, "type": "SCALAR"},
 {"componentType": 5126, "count": 65000, "type": "SCALAR"}'
gltf weights.gltf "$(list 5000 '{"mesh": 0}')" '' '' "$numbers" '' \
    ", \"animations\": [{\"samplers\": [{\"input\": 1, \"output\": 2}],
  \"channels\": [$(list 5000 '{"sampler": 0, "target":
  {"node": @, "path": "weights"}}')]}]"
run $b --anim-time 0 weights.gltf

# instances without extent, which are copies: 21,666 triangles in each
gltf flat.gltf '{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
 {"attributes": {"SCALE": 1}}}}' '' '' "$zeros" '' '' \
    '{"attributes": {"POSITION": 1}}'
run $b flat.gltf

# skins that take turns to bend a mesh of 21,666 triangles
gltf skins.gltf "{},$(list 999 '{"mesh": 0, "skin": 0}, {"mesh": 0, "skin": 1}')" \
    '' '' "$zeros" '' ', "skins": [{"joints": [0]}, {"joints": [0]}]' \
    '{"attributes": {"POSITION": 1}}'
run $b skins.gltf

# two million nodes of 3 bytes
gltf nodes.gltf "{\"mesh\": 0},$(list 2000000 '{}')"
run $b nodes.gltf

# images that are overlapping views of one buffer
gltf views.gltf '{"mesh": 0}' '' ', {"uri": "big.bin", "byteLength": 60000000}' \
    '' ", $(list 99 '{"buffer": 1, "byteOffset": @, "byteLength": 50000000}')" \
    ", \"images\": [$(list 99 '{"bufferView": @, "mimeType": "image/png"}')],
 \"textures\": [$(list 99 '{"source": @}')],
 \"materials\": [$(list 99 '{"normalTexture": {"index": @}}')]"
run $b views.gltf
