# SPDX-License-Identifier: MIT
# glTF files: what options choose of them gives the pictures of files that have
# nothing else; messages for choices and files that are wrong.
b="-b -w 16 -h 9 -s 2"

# A triangle of positions (0,0,0), (1,0,0), (0,1,0) with keys at 0 and 1 second,
# at which it is moved by (0,0,0) and (2,0,0).
gltf() # DEFAULT_SCENE DEFAULT_MATERIAL NODE_MEMBERS
{
    zero=%00%00%00%00
    one=%00%00%80%3f
    two=%00%00%00%40
    positions=$zero$zero$zero$one$zero$zero$zero$one$zero
    keys=$zero$one$zero$zero$zero$two$zero$zero
    cat <<END
{"asset": {"version": "2.0"}, "scene": $1,
 "extensionsUsed": ["KHR_materials_variants"],
 "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}},
 "scenes": [{"nodes": [0, 2]}, {"name": "far", "nodes": [1, 2]}],
 "nodes": [{"mesh": 0 ${3-}}, {"mesh": 0, "translation": [0, 3, 0]},
  {"camera": 0, "translation": [1, 1, 6]}],
 "cameras": [{"type": "perspective",
  "perspective": {"yfov": 0.9, "znear": 0.1}}],
 "materials": [{}, {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": $2,
  "extensions": {"KHR_materials_variants":
   {"mappings": [{"material": 1, "variants": [0]}]}}}]}],
 "animations": [{"name": "slide", "channels": [
  {"sampler": 0, "target": {"node": 0, "path": "translation"}}],
  "samplers": [{"input": 1, "output": 2}]}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
  {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36},
  {"buffer": 1, "byteLength": 8},
  {"buffer": 1, "byteOffset": 8, "byteLength": 24}],
 "buffers": [{"byteLength": 36, "uri": "data:,$positions"},
  {"byteLength": 32, "uri": "data:,$keys"}]}
END
}
gltf 0 0 >model.gltf
gltf 1 0 >far.gltf
gltf 0 1 >red.gltf
gltf 0 0 ', "translation": [1, 0, 0]' >moved.gltf
for name in model far red moved; do
    glim $b -o $name.pfm $name.gltf 2>/dev/null
done
chosen() # FILE OPTIONS
{
    glim $b -o chosen.pfm $2 model.gltf 2>/dev/null
    same $1.pfm chosen.pfm
}
chosen far '--scene far'
chosen far '--scene 2'
chosen red '--variant red'
chosen moved '--anim-time 0.5'
chosen moved '--anim-time 0.5 --animation slide'
chosen model '--animation 1'
chosen model '--camera 1'
same model.pfm far.pfm
same model.pfm red.pfm
same model.pfm moved.pfm
run $b -o x.pfm --scene near model.gltf
run $b -o x.pfm --variant 2 model.gltf
run $b -o x.pfm --animation 0 model.gltf
run $b -o x.pfm --anim-time never model.gltf
run $b -o x.pfm --camera 2 model.gltf
echo '{"asset": {"version": "1.0"}}' >old.gltf
run $b -o x.pfm old.gltf
echo '{"asset": {"version": "2.0"}, "nodes": [{"mesh": 3}]}' >bad.gltf
run $b -o x.pfm bad.gltf
echo '{"asset": {"version": "2.0"}, "nodes": [{"children": [0]}]}' >bad.gltf
run $b -o x.pfm bad.gltf
echo '{"asset": {"version": "2.0"},' >bad.gltf
run $b -o x.pfm bad.gltf
echo '{"asset": {"version": "2.0"}, "extensionsRequired": ["ACME_x"]}' >bad.gltf
run $b -o x.pfm bad.gltf
# A directional light of 2 lx, and one of 2 W/m2 as Blender writes it.
lit() # LUX GENERATOR
{
    light='"KHR_lights_punctual": {"light": 0}'
    lights='"KHR_lights_punctual": {"lights": [{"type": "directional",'
    gltf 0 0 | sed "s|\"version\"|\"generator\": \"$2\", &|
        s|^ \"extensions\": {|&$lights \"intensity\": $1}]}, |
        s|\[1, 1, 6\]|&, \"extensions\": {$light}|"
}
lit 2 "a tool" >lit.gltf
lit 1366 "Khronos glTF Blender I/O v3.6.27" >watts.gltf
lit 1366 "a tool" >lumens.gltf
for name in lit watts lumens; do
    glim $b -o $name.pfm $name.gltf 2>/dev/null
done
same lit.pfm watts.pfm
same lit.pfm lumens.pfm
echo '{"asset":{"version":"2.0"},"scenes":[{"nodes":[]}],"scene":0}' >none.gltf
run -b --animation 1 -o none.png none.gltf
