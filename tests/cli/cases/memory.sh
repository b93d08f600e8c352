# SPDX-License-Identifier: MIT
# Images beyond the available memory are refused in the order of the file,
# before they are decoded.
b="-b -w 8 -h 8 -s 1 -t 1 -o out.png"
# one thread, since threads use part of the limited memory
export MALLOC_ARENA_MAX=1
ulimit -s 1024

# a megabyte for 32 million pixels, in runs of 128, the longest
{
    printf '\0\0\012\0\0\0\0\0\0\0\0\0\100\037\240\017\030\0'
    printf '%250000s' '' | sed 's/ /\xffabc/g'
} >1.tga
for i in 2 3 4 5 6; do
    cp 1.tga $i.tga
done
textured 6
limit_memory 1000000 || skip "the sanitizers' own memory is beyond any limit"
run_untimed $b textured.obj
sed -i 's/[2-6]\.tga/1.tga/' textured.mtl
run_untimed $b textured.obj
echo 'sky 2.tga' >textured.view
run $b textured.obj
printf 'sky small.tga\n' >textured.view
{
    printf '\0\0\012\0\0\0\0\0\0\0\0\0\240\017\240\017\030\0'
    printf '%125000s' '' | sed 's/ /\xffabc/g'
} >small.tga
run_untimed $b textured.obj
# four textures and the sky are too large together
textured 4
echo 'sky small.tga' >textured.view
run $b textured.obj
