# SPDX-License-Identifier: MIT
# Properties of surfaces in files beside the picture.
take box
b="-b -w 24 -h 16 -s 2"
for list in '' normals, ,depth normal Depth 'uv, depth'; do
    run $b --aov "$list" box.obj
done
run --aov depth box.obj
run $b --aov depth --show normals box.obj
run $b --aov depth --ansi 8x4 box.obj
run $b --aov depth -o - box.obj
run merge --aov depth -o a.png a.film
run $b --aov depth -o a.png --error-map a.depth.pfm box.obj
run $b --aov depth -o none/a.png box.obj
mkdir a.depth.pfm
run $b --aov uv,depth -o a.png box.obj
rmdir a.depth.pfm
ls

run_untimed $b --aov albedo,normals,position,depth,uv,object,material \
    -o a.png box.obj
for file in a.*.pfm; do
    kind "$file"
done
# the picture stays as it is, and other samples have the same surfaces
glim $b -o b.png box.obj 2>/dev/null
same a.png b.png
glim $b -s 1 --seed 0 -t 1 --aov albedo,depth -o c.png box.obj 2>/dev/null
same a.albedo.pfm c.albedo.pfm
same a.depth.pfm c.depth.pfm
# a new name each time without -o
glim $b --aov depth box.obj 2>/dev/null
glim $b --aov depth box.obj 2>/dev/null
ls box*
run_untimed $b --aov depth --turntable 2 -o t.png box.obj
ls t*

# an EXR picture has them as layers
run_untimed $b --aov albedo,normals,position,depth,uv,object,material \
    -o a.exr box.obj
kind a.exr
ls a.*
run_untimed $b --aov depth --denoise=d.exr -o e.exr box.obj
kind d.exr
kind e.exr
mkdir f.exr
run $b --aov depth -o f.exr box.obj
