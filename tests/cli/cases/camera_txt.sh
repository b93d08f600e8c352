# SPDX-License-Identifier: MIT
# Order of view files: -c, then SCENE.view, then camera.txt in the folder.
mkdir d
cp "$CLI"/scenes/box.* d
rm d/box.view
view='eye 0 1 4\nat 0 1 0\nfovy 40\n'
printf "${view}res 12 4\n" >d/camera.txt
run_untimed -b -s 1 -o out.png d/box.obj
printf "${view}res 5 7\n" >d/box.view
run_untimed -b -s 1 -o out.png d/box.obj
printf "${view}res 30 20\n" >other.view
run_untimed -b -s 1 -o out.png -c other.view d/box.obj
echo 'one side keeps the shape:'
run_untimed -b -s 1 -w 15 -o out.png -c other.view d/box.obj
run_untimed -b -s 1 -h 3 -o out.png -c other.view d/box.obj
run_untimed -b -s 1 -w 1 -h 9 -o out.png -c other.view d/box.obj

echo 'other keys, and another name of sky:'
rm d/box.view
glim -b -s 1 -w 2 -h 1 -o sky.pfm d/box.obj 2>/dev/null
printf "${view}res 6 4\nbackground_map sky.pfm\n" >d/camera.txt
cp sky.pfm d
run_untimed -b -s 4 -o named.pfm d/box.obj
printf "${view}res 6 4\nsky sky.pfm\n" >d/camera.txt
run_untimed -b -s 4 -o sky.pfm d/box.obj
same named.pfm sky.pfm
printf "${view}res 6 4\nspp 64\nsensor 36 24\nspp 2\n" >d/camera.txt
run_untimed -b -s 1 -o out.png d/box.obj
printf "${view}background_map\n" >d/camera.txt
run_untimed -b -s 1 -o out.png d/box.obj
