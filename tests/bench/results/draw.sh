#!/bin/bash
# SPDX-License-Identifier: MIT
# draw.sh - makes the tables and diagrams of docs/results.md from
# docs/results/*.csv
#
# usage: draw.sh          writes both
#        draw.sh --check  tells whether the tables are those of the CSV files
#
# A table is between the lines "<!-- table NAME -->" and "<!-- end -->". The text
# around it is written by people.
set -eu -o pipefail
cd "$(dirname "$0")/../../.."
results=docs/results
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

rows() { # NAME: the rows of a CSV file
    grep -v '^#' "$results/$1.csv" | sed 1d
}

# Prints a table from comma-separated lines, the first of which is its head.
table() {
    awk -F, '{
            line = "|"
            for (i = 1; i <= NF; i++) line = line " " $i " |"
            print line
            if (NR == 1) {
                line = "|"
                for (i = 1; i <= NF; i++) line = line (i == 1 ? " --- |" : " ---: |")
                print line
            }
        }'
}

# Prints where and how the figures of CSV files were measured.
origin() { # NAME...
    local name

    for name; do
        sed -n '1s/^# //p' "$results/$name.csv"
    done | awk '{ printf "%s%s", (NR > 1 ? "; " : "\n*"), $0 }'
    sed -n "2s/^# \(.*\)/: \`\1\`*/p" "$results/$1.csv"
}

plain() { # NAME: the file as it is
    grep -v '^#' "$results/$1.csv" | table
    origin "$1"
}

# Prints a table of one value by row, column and scene.
frames_of() { # SCENE
    rows frames | awk -F, -v scene="$1" '$1 == scene {
            if (!($2 in seen)) { seen[$2] = 1; size[++sizes] = $2 }
            if (!($3 in known)) { known[$3] = 1; depth[++depths] = $3 }
            cell[$2, $3] = $4 == "" ? "-" : $4 " (" $5 " %)"
        }
        END {
            line = scene
            for (d = 1; d <= depths; d++)
                line = line "," depth[d] (depth[d] == 1 ? " bounce" : " bounces")
            print line
            for (s = 1; s <= sizes; s++) {
                line = size[s]
                for (d = 1; d <= depths; d++) line = line "," cell[size[s], depth[d]]
                print line
            }
        }' | sed 's/any bounces/any number/' | table
}

table_frames() {
    local scene

    for scene in $(rows frames | cut -d , -f 1 | uniq); do
        frames_of "$scene"
        echo
    done | sed '$d'
    origin frames
}

table_slopes() {
    {
        echo 'scene,slope,95 % interval,relMSE at 1 sample,at 1024'
        {
            rows convergence | sed 's/^/point,/'
            rows slopes | sed 's/^/slope,/'
        } | awk -F, '$1 == "point" && $3 == 1 { first[$2] = $6 }
            $1 == "point" && $3 == 1024 { last[$2] = $6 }
            $1 == "slope" { printf "%s,%s,%s to %s,%.2g,%.2g\n", $2, $3, $4, $5,
                first[$2], last[$2] }'
    } | table
    origin slopes
}

# What the checks of `make stress` attack.
attacks='samples|single kernels: estimates, densities and energy at extreme numbers
geometry|slivers, huge and tiny triangles, coplanar faces, far origins, edges
light|lamps and skies of extreme size, brightness and distance
error|whether the stated error is true, over 200 renders of each scene
filter|whether filtered pictures have less error, at 4 to 4,096 samples
gltf|regions of glTF scenes beside the pictures of Cycles and Mitsuba
blender|materials that Blender exports, beside its own pictures
films|renders that stop, move, are killed and cut in pieces: the same bytes
schedulers|the recipes for clusters
extremes|random scenes of extreme numbers: not one value that is not finite
sizes|pictures of 1x1 to 65536x65536 pixels under a limit of memory
keys|random keys on the screen
rays|1e8 rays at edges and vertices: no leaks, the same hit as brute force
oclgrind|each memory access of the kernels, in a simulator
valgrind|memory of the program, with the CPU and with a device'

table_stress() {
    {
        echo 'check,attacks,cases,passed'
        {
            echo "$attacks" | tr ',|' ';,' | sed 's/^/text,/'
            rows stress | sed 's/^/row,/'
        } | awk -F, '$1 == "text" { text[$2] = $3 }
            $1 == "row" { print $2 "," text[$2] "," $3 "," $4 }'
    } | table | sed 's/;/,/g'
    origin stress
}

# Gains of the filter by scene and samples, and their geometric means.
table_filter() {
    rows filter | awk -F, '{
            if (!($1 in seen)) { seen[$1] = 1; scene[++scenes] = $1 }
            if (!($2 in known)) { known[$2] = 1; spp[++counts] = $2 }
            least = $5 / 10
            gain[$1, $2] = $3 / ($4 > least ? $4 : least)
        }
        END {
            line = "scene"
            for (i = 1; i <= counts; i++) line = line "," spp[i] " samples"
            print line
            for (s = 1; s <= scenes; s++) {
                line = scene[s]
                for (i = 1; i <= counts; i++) {
                    line = line "," sprintf("%.3g", gain[scene[s], spp[i]])
                    product[i] += log(gain[scene[s], spp[i]])
                }
                print line
            }
            line = "geometric mean"
            for (i = 1; i <= counts; i++)
                line = line "," sprintf("%.3g", exp(product[i] / scenes))
            print line
        }' | table
    origin filter
}

# The filtered picture of glim at the time that Cycles with OIDN takes: errors
# between two measurements are interpolated in logarithms, and after the last
# one its error counts.
table_peers() {
    {
        echo 'scene,Cycles with OIDN: samples,seconds,relMSE,glim filtered: relMSE after the same seconds,error lower by,by processor time'
        {
            rows peers
            rows cycles
        } | awk -F, '
            function after(column, scene, time,   i, t) {
                if (time >= at[column, scene, count[scene]])
                    return error[scene, count[scene]]
                i = 2
                while (at[column, scene, i] < time) i++
                t = log(time / at[column, scene, i - 1])
                t /= log(at[column, scene, i] / at[column, scene, i - 1])
                t *= log(error[scene, i] / error[scene, i - 1])
                return error[scene, i - 1] * exp(t)
            }
            $2 == "glim filtered" {
                count[$1]++
                at[4, $1, count[$1]] = $4
                at[5, $1, count[$1]] = $5
                error[$1, count[$1]] = $6
            }
            $2 == "Cycles with OIDN" {
                e = after(4, $1, $4)
                printf "%s,%d,%.2f,%.2g,%.2g,%.1f,%.1f\n", $1, $3, $4, $6, e,
                    $6 / e, $6 / after(5, $1, $5)
            }'
    } | table
    origin peers cycles
}

table_samples() {
    plain samples
}

table_cores() {
    plain cores
}

table_theses() {
    plain theses
}

table_box() {
    plain box
}

table_triangles() {
    plain triangles
}

table_features() {
    plain features
}

table_adaptive() {
    plain adaptive
}

table_oidn() {
    plain oidn
}

table_surfaces() {
    plain surfaces
}

table_blender() {
    plain blender
}

table_calibration() {
    plain calibration
}

# Replaces the tables of the file.
with_tables() {
    local line name is_inside=''

    while IFS= read -r line; do
        [ "$line" != '<!-- end -->' ] || is_inside=''
        [ -n "$is_inside" ] || printf '%s\n' "$line"
        case $line in
        '<!-- table '*' -->')
            name=${line#<!-- table }
            name=${name% -->}
            echo
            if [ -e "$results/$name.csv" ]; then
                "table_$name"
            else
                echo '(not measured yet)'
            fi
            echo
            is_inside=yes
            ;;
        esac
    done <docs/results.md
}

# Draws curves from standard input, lines of NAME,X,Y, in the order in which
# their names first occur. A curve whose name begins with "-" is a thin line
# without points. The axes are logarithmic, or only that of x with "linear".
plot() { # NAME TITLE X_LABEL Y_LABEL [linear]
    {
        echo 'set terminal pngcairo noenhanced size 880,540'
        echo 'set colorsequence podo'
        echo "set format '%g'"
        echo 'set grid'
        echo 'set key outside Left reverse'
        echo "set logscale ${5:+x}"
        echo "${5:+set yrange [0:*]}"
        echo "set output '$results/$1.png'"
        echo "set title '$2'; set xlabel '$3'; set ylabel '$4'"
        awk -F, '
            !($1 in points) { name[count++] = $1 }
            { points[$1] = points[$1] $2 " " $3 "\n" }
            END {
                for (i = 0; i < count; i++)
                    printf "$curve%d << END\n%sEND\n", i, points[name[i]]
                for (i = 0; i < count; i++) {
                    style = "linespoints linewidth 2 pointtype " (i < 8 ? 7 : 6)
                    if (sub(/^-/, "", name[i]))
                        style = "lines dashtype 2 linecolor \"grey40\""
                    printf "%s $curve%d with %s title \"%s\"",
                        (i == 0 ? "plot" : ","), i, style, name[i]
                }
                print ""
            }'
    } | gnuplot
}

# Error against time or samples of all renderers.
plot_peers() { # SCENE TITLE
    {
        rows peers
        rows cycles
    } | grep "^$1," >"$work/curves"
    awk -F, '{ print $2 "," $3 "," $6 }' "$work/curves" |
        plot "$1_samples" "$2" 'samples per pixel' 'relative MSE'
    awk -F, '{ print $2 "," $5 "," $6 }' "$work/curves" |
        plot "$1_time" "$2" 'processor seconds' 'relative MSE'
}

plot_all() {
    plot_peers cornell 'Cornell box, 256x256 pixels'
    plot_peers sky 'Under a sky, 256x256 pixels'
    rows convergence | awk -F, '{ print $1 "," $4 "," $5
            if (NR == 1) { x = $4; y = $5 } }
        END { print "-slope -0.5," x "," y; print "-slope -0.5," 1024 * x "," y / 1024 }' |
        plot convergence 'Error against time' 'processor seconds' 'relative MSE'
    rows triangles | awk -F, '{ print "camera rays," $1 "," $2
            print "bounces," $1 "," $3
            print "shadow rays," $1 "," $4 }' |
        plot triangles 'Time of a ray' 'triangles' 'nanoseconds' linear
}

with_tables >"$work/results.md"
if [ "${1:-}" = --check ]; then
    diff "$work/results.md" docs/results.md
    exit
fi
cat "$work/results.md" >docs/results.md
tests/tools/deps.sh results
plot_all
