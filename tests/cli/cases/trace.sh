# SPDX-License-Identifier: MIT
# --trace prints the path of a sample of a saved picture. The truth is the
# picture: the mean of all samples of a pixel is the pixel.
take box
b="-b -w 9 -h 5 -s 4 --seed 7 --no-adaptive"

# Prints the path's radiance.
radiance()
{
    glim --trace "$@" | sed -n 's/^radiance *//p'
}

# Prints a pixel of a PFM of $2 pixels a row: column $3, row $4 from below.
pixel()
{
    tail -c "$((12 * $2 * $5))" "$1" | od -A n -v -t f4 -w12 |
        sed -n "$(($4 * $2 + $3 + 1))p"
}

# Compares the mean of all samples of a pixel with the pixel of a PFM.
check_mean()
{
    name=$1 width=$2 height=$3 x=$4 y=$5 spp=$6
    shift 6
    i=0
    while [ $i -lt "$spp" ]; do
        radiance "$x,$y,$i" "$@"
        i=$((i + 1))
    done | awk -v want="$(pixel "$name" "$width" "$x" \
        $((height - 1 - y)) "$height")" '
        { for (k = 1; k <= 3; k++) sum[k] += $k }
        END {
            split(want, p, " ")
            for (k = 1; k <= 3; k++) {
                difference = sum[k] / NR - p[k]
                if (difference < 0)
                    difference = -difference
                bright += p[k] > 0
                bad += difference > 2e-7 * p[k]
            }
            print NR " samples, " (bad ? "another mean" : "the same mean"),
                (bright ? "" : "of black")
        }' | sed 's/ $//'
}

glim $b -o a.pfm box.obj 2>/dev/null
for format in png hdr exr; do
    glim $b -o a.$format box.obj 2>/dev/null
    check_mean a.pfm 9 5 4 2 4 a.$format
done
check_mean a.pfm 9 5 6 3 4 -w 9 -h 5 --seed 7 box.obj
glim $b --crop 3,1,4,3 -o c.png box.obj 2>/dev/null
radiance 1,1,2 c.png >crop
radiance 4,2,2 a.png >whole
same crop whole

# scenes with glass, media, dispersion, a guide, light paths, and cells: these
# come after 65536 samples of all pixels
for scene in glass_mirror fog prism milk interior; do
    glim -b -w 32 -h 20 -s 6 --no-adaptive -o b.pfm \
        "$root/scenes/$scene.obj" 2>/dev/null
    check_mean b.pfm 32 20 17 11 6 -w 32 -h 20 "$root/scenes/$scene.obj"
done
glim -b -w 512 -h 320 -s 2 --no-adaptive --crop 300,150,3,3 -o b.pfm \
    "$root/scenes/interior.obj" 2>/dev/null
check_mean b.pfm 3 3 1 1 2 -w 512 -h 320 --crop 300,150,3,3 \
    "$root/scenes/interior.obj"
glim --trace 1,1,1 -w 512 -h 320 --crop 300,150,3,3 "$root/scenes/interior.obj" |
    grep -c -e ' cell  '

# the table
run --trace 4,2,1 a.png
run --trace 0,0,0 a.png

# errors
run --trace 9,2,0 a.png
run --trace 4,2,4 a.png
run --trace 4,2 a.png
run --trace 4,2,1x a.png
run --trace 4,2,1 a.pfm
run --trace 4,2,1 none.png
run --trace 4,2,1
run --trace 4,2,1 -o b.png a.png
run --trace 4,2,1 --seed 8 a.png
run --trace 4,2,1 -w 10 a.png
glim -b -w 9 -h 5 -s 20 --adaptive -o d.png box.obj 2>/dev/null
run --trace 4,2,19 d.png | grep -e warning -e exit
mkdir below
mv a.png below
run --trace 0,0,0 below/a.png | tail -n 2
cp box.mtl kept.mtl
sed 's/^Kd .*/Kd 0.5 0.5 0.5/' kept.mtl >box.mtl
run --trace 4,2,1 below/a.png
mv box.obj other.obj
run --trace 4,2,1 below/a.png
mv kept.mtl box.mtl
run --trace 0,0,0 below/a.png other.obj | tail -n 2
