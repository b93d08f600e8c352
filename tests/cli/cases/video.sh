# SPDX-License-Identifier: MIT
# Videos go through a process of ffmpeg, which a script stands for here.
take box
mkdir bin
cat >bin/ffmpeg <<'SH'
#!/bin/sh
echo "$@" >arguments
cat >got.rgb
SH
chmod +x bin/ffmpeg
real=$PATH
PATH=$PWD/bin:$PATH
b="-b -w 25 -h 16 -s 2"
run $b -o a.mp4 box.obj
run $b --turntable 2 -o a.avi box.obj
run $b --turntable 2 -o none/a.mp4 box.obj
run $b --turntable 2 -o a.mp4 --aov depth box.obj
run_untimed $b --turntable 3 --fps 12.5 -o a.mp4 box.obj
cat arguments
glim $b --turntable 3 -o a.png box.obj 2>/dev/null
for k in 0 1 2; do
    (
        printf 'P6 25 16 255\n'
        tail -c +$((1200 * k + 1)) got.rgb | head -c 1200
    ) >got.ppm
    glim compare got.ppm a-000$k.png | grep '^largest'
done
run_untimed $b --turntable 2 --frames 1:1 --show normals -o a.webp box.obj
cat arguments
wc -c <got.rgb

printf '#!/bin/sh\ncat >/dev/null\nexit 3\n' >bin/ffmpeg
run_untimed $b --turntable 2 -o a.mp4 box.obj
# one that ends early breaks the pipe
printf '#!/bin/sh\nexec <&-\nexit 0\n' >bin/ffmpeg
glim -b -w 256 -h 256 -s 1 --turntable 9 -o a.mp4 box.obj >out 2>&1
echo "exit $?"
tail -n 1 out
glim=$(command -v glim)
PATH=$PWD/none
"$glim" $b --turntable 2 --frames 1:1 -o a.webm box.obj 2>err
echo "exit $?"
PATH=$real
untimed err
ls
