#!/bin/bash
# SPDX-License-Identifier: MIT
# measure.sh - measures the figures of docs/results.md (`make results`)
#
# Each section writes docs/results/SECTION.csv, from which draw.sh makes tables
# and diagrams. Its first lines name the machine, the date, the version and the
# command. A section that cannot be measured here prints the reason, and its
# file stays.
#
# BUILD is the folder of the program. FILTER selects a section. Optional:
# PEER       a Python that has bpy, Blender as a module (sections peers, box
#            and blender)
# OIDN       a Python that has pyoidn and numpy (section oidn)
# STRESS_LOG output of an earlier `make stress` (sections stress, calibration,
#            filter, blender), else the checks run, which takes up to an hour
set -eu
cd "$(dirname "$0")/../../.."
build=${BUILD:-build/release}
filter=${FILTER:-}
shared=${GLIM_SHARED:-../shared}
results=docs/results
cache=build/results
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$results" "$cache"

shipped='cornell.obj materials.obj glass_mirror.obj interior.obj skylit.obj'
shipped="$shipped lights200.obj principled.obj prism.obj fog.obj lantern.obj"
shipped="$shipped milk.obj bottles.glb bubbles.glb busts.glb chess.glb"
shipped="$shipped forest.glb jellyfish.glb knot.glb"
sections='samples cores theses box frames triangles features convergence peers'
sections="$sections oidn stress calibration filter adaptive blender surfaces"

say() {
    echo "results: $*"
}

machine() {
    local cores shared_word=''

    cores=$(nproc)
    awk '{ exit !($1 > .5) }' /proc/loadavg && shared_word='shared '
    echo "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)," \
        "$cores ${shared_word}cores"
}

# Writes docs/results/NAME.csv from the rows of standard input, unless there are
# none. The header is that of the columns. $renderer replaces glim's version.
save() { # NAME HEADER
    cat >"$work/rows"
    [ -s "$work/rows" ] || {
        say "$1: no rows; $results/$1.csv stays"
        return 0
    }
    {
        echo "# $machine, $(date +%F), ${renderer:-$("$build/glim" --version |
            head -n 1)}"
        echo "# make results FILTER=$section"
        echo "$2"
        cat "$work/rows"
    } >"$results/$1.csv"
    say "$results/$1.csv"
}

value() { # KEY FILE: a number of --stats
    sed -n "s/.*\"$1\": *\"*\([0-9.e+-]*\).*/\1/p" "$2" | head -n 1
}

# Runs a command and sets cpu_s to its processor time. Its output goes to
# $work/said.
timed() {
    local TIMEFORMAT='%U %S'

    { time "$@" >"$work/said" 2>&1; } 2>"$work/time" || {
        cat "$work/said" >&2
        return 1
    }
    cpu_s=$(awk '{ print $1 + $2 }' "$work/time")
}

# Prints the relative MSE of a picture.
relmse() { # PICTURE REFERENCE
    "$build/glim" compare "$1" "$2" 2>/dev/null |
        sed -n 's/^relMSE *\([0-9.e+-]*\).*/\1/p'
}

# One scene at three numbers of samples, raw and filtered.
measure_samples() {
    local n error

    for n in 1 16 1024; do
        # one sample has no second half, so its picture is not filtered
        "$build/glim" -b -w 320 -h 180 -s $n -o "$results/samples_$n.png" \
            --denoise="$results/samples_${n}_filtered.png" \
            --stats "$work/stats" scenes/interior.obj 2>"$work/said"
        error=$(value error "$work/stats")
        echo "$n,$(awk -v e="${error:-0}" 'BEGIN {
                if (e > 0) printf "%.1f %%", 100 * e
                else print "unknown" }')"
    done | save samples 'samples per pixel,stated error of the raw picture'
}

# The fastest of three runs for each number of threads. Rows of other machines
# stay.
measure_cores() {
    local name

    name="${machine%%, *} with $(nproc) cores"
    {
        grep -v -e '^#' -e '^machine,' -e "^$name," "$results/cores.csv" || :
        for _ in 1 2 3; do
            FILTER=threads tests/bench/run.sh
        done | awk -v name="$name" '$1 ~ /^[0-9]+$/ && NF == 4 {
                if (!($1 in s) || $2 < s[$1]) { s[$1] = $2; rate[$1] = $3 }
                if ($1 > most) most = $1
            }
            END { for (n = 1; n <= most; n++)
                printf "%s,%d,%.2f,%.2f,%.2f\n", name, n, s[n], rate[n],
                    s[1] / s[n] }'
    } | save cores 'machine,threads,seconds,million samples per second,speed-up'
}

# The picture that the thesis on trac0r counts rays for: 30 paths of five rays
# for each of 1920x1080 pixels; beside it direct light alone and all light.
measure_theses() {
    local scene light

    for scene in cornell interior; do
        for light in 'direct light:-d 1' 'paths of 5 rays:-d 4' 'all light:'; do
            # shellcheck disable=SC2086 # an option and its number
            "$build/glim" -b -w 1920 -h 1080 -s 30 ${light#*:} \
                --stats "$work/stats" -o "$work/picture.pfm" \
                "scenes/$scene.obj" 2>"$work/said"
            echo "$scene,${light%:*},$(value render_s "$work/stats"),$(value \
                samples "$work/stats"),$(value rays "$work/stats"),$(value \
                error "$work/stats")"
        done
    done | awk -F, '{ printf "%s,%s,%.1f,%.2f,%.2f,%.1f,%.1f %%\n", $1, $2, $3,
            $4 / $3 / 1e6, $5 / $3 / 1e6, $5 / 1920 / 1080, 100 * $6 }' |
        save theses 'scene,light,seconds,million samples per second,million rays per second,rays per pixel,stated error'
}

# Prints the 16 means of a 4x4 grid of a square PFM picture: row, column, red,
# green, blue.
region_means() { # PICTURE SIDE
    tail -c $((12 * $2 * $2)) "$1" | od -An -v -tf4 -w12 |
        awk -v side="$2" '{
                row = int((side - 1 - int((NR - 1) / side)) * 4 / side)
                column = int((NR - 1) % side * 4 / side)
                for (c = 1; c <= 3; c++) sum[row, column, c] += $c
            }
            END { n = side * side / 16
                for (row = 0; row < 4; row++)
                    for (column = 0; column < 4; column++)
                        print row + 1, column + 1, sum[row, column, 1] / n,
                            sum[row, column, 2] / n, sum[row, column, 3] / n }'
}

# The published Cornell box in 16 regions, beside those of Cycles: means over
# eight seeds, and the largest difference of a channel. The file has the front of
# the tall box twice, between which Cycles loses light, so one goes. Cycles'
# light samples are exact for small triangles only, hence --scale.
measure_box() {
    local box=$shared/scenes-real/CornellBox-Original seed version
    local out=$work/picture.pfm

    if [ -z "${PEER:-}" ] || [ ! -d "$box" ]; then
        say "box: skipped, PEER is not set or $box is missing"
        return 0
    fi
    version=$("$PEER" -c 'import bpy; print(bpy.app.version_string)' | tail -n 1)
    grep -v '^f -8 -7 -6 -5' "$box/CornellBox-Original.obj" >"$work/box.obj"
    cp "$box/CornellBox-Original.mtl" "$work"
    sed 's/^res .*/res 128 128/' "$box/camera.txt" >"$work/camera.txt"
    for seed in 1 2 3 4 5 6 7 8; do
        "$build/glim" -b -w 128 -h 128 -s 1024 --seed $seed -o "$out" \
            "$work/box.obj" 2>"$work/said"
        region_means "$out" 128 >"$work/means"
        "$PEER" "$shared/lab/peers/render_cycles.py" -- --scene "$work/box.obj" \
            --camera "$work/camera.txt" --scale .001 --spp 256 --threads 2 \
            --seed $seed --out "$out" >"$work/said" 2>&1
        region_means "$out" 128 | paste -d ' ' "$work/means" -
    done | awk '{
            at = $1 "," $2
            if (!(at in n)) order[++count] = at
            n[at]++
            for (c = 3; c <= 5; c++) {
                ours[at, c] += $c
                theirs[at, c] += $(c + 5)
                squares[at, c] += ($c - $(c + 5)) ^ 2
            }
        }
        END { for (i = 1; i <= count; i++) {
            at = order[i]
            a = b = ""
            share = errors = 0
            for (c = 3; c <= 5; c++) {
                x = ours[at, c] / n[at]
                y = theirs[at, c] / n[at]
                e = sqrt((squares[at, c] / n[at] - (x - y) ^ 2) / (n[at] - 1))
                a = a sprintf(" %.4f", x)
                b = b sprintf(" %.4f", y)
                if ((x / y - 1) ^ 2 > share ^ 2) share = x / y - 1
                if (((x - y) / e) ^ 2 > errors ^ 2) errors = (x - y) / e
            }
            printf "%s,%s,%s,%.2f %%,%.1f\n", at, substr(a, 2), substr(b, 2),
                100 * share, errors
        } }' | renderer="$("$build/glim" --version | head -n 1), Cycles $version" \
        save box 'row,column,glim,Cycles,largest difference,in standard errors'
}

# Cells of the table of bench/frames are "SAMPLES ERROR %" or "-".
measure_frames() {
    "$build/bench/frames" scenes/cornell.obj scenes/interior.obj |
        awk '$2 == "bounces:" {
                scene = $1
                gsub(/.*\/|\.obj/, "", scene)
                for (i = 3; i <= NF; i++) bounces[i - 2] = $i
                next
            }
            {
                column = 0
                for (i = 2; i <= NF; i++) {
                    column++
                    printf "%s,%s,%s,", scene, $1, bounces[column]
                    if ($i == "-") print ","
                    else { print $i "," $(i + 1); i += 2 }
                }
            }' | save frames 'scene,size,bounces,samples per pixel,error %'
}

# Renders a scene with eight seeds, uniform and adaptive in turns, and prints the
# ratios of the sums of squared errors and rays, and of the least times.
compare_adaptive() { # SCENE
    local seed option

    for seed in 1 2 3 4 5 6 7 8; do
        for option in --no-adaptive --adaptive; do
            timed "$build/glim" -b -t 1 $option -s 128 -w 160 -h 120 \
                --seed $seed --stats "$work/stats" -o "$work/out.pfm" "$1"
            echo "$option $(value error "$work/stats") $(value rays \
                "$work/stats") $cpu_s"
        done
    done | awk '{ squares[$1] += $2 * $2; rays[$1] += $3
            if (!($1 in cpu) || $4 < cpu[$1]) cpu[$1] = $4 }
        END { u = "--no-adaptive"; a = "--adaptive"
            e = squares[u] / squares[a]; r = rays[a] / rays[u]
            t = cpu[a] / cpu[u]
            printf "%.2f,%.2f,%.2f,%.2f,%.2f\n", e, r, t, e / r, e / t }'
}

# Adaptive against uniform sampling.
measure_adaptive() {
    local name scene all=''

    for name in $shipped; do
        all="$all scenes/$name"
    done
    for name in scenes-bench/sky scenes-bench/many_lights scenes-real/bunny \
        scenes-real/spot scenes-real/teapot scenes-real/CornellBox-Glossy; do
        scene=$shared/$name/${name#*/}.obj
        [ ! -e "$scene" ] || all="$all $scene"
    done
    for scene in $all; do
        name=${scene##*/}
        echo "${name%.*},$(compare_adaptive "$scene")"
    done | save adaptive 'scene,squared error lower by,rays more by,processor time more by,gain by rays,gain by time'
}

measure_triangles() {
    "$build/rays/scaling" | awk '$1 ~ /^[0-9]+$/ {
            printf "%d,%s,%s,%s,%s,%s\n", $1, $4, $5, $6, $2, $3 }' |
        save triangles 'triangles,camera ray (ns),bounce (ns),shadow ray (ns),build (s),bytes per triangle'
}

# Joins the two benchmarks of kernels without unused features.
measure_features() {
    FILTER=instructions tests/bench/run.sh >"$work/instructions"
    FILTER=builds tests/bench/run.sh >"$work/builds"
    awk '$1 ~ /\.obj$/ {
            scene = $1
            gsub(/.*\/|\.obj/, "", scene)
            if (NF == 3) { whole[scene] = $2; own[scene] = $3 }
            else if (scene in own)
                printf "%s,%d,%d,%.1f %%,%.1f %%\n", scene, whole[scene],
                    own[scene], 100 * (1 - own[scene] / whole[scene]),
                    100 * (1 - 1 / $5)
        }' "$work/instructions" "$work/builds" |
        save features 'scene,instructions per sample with all features,with those of the scene,fewer instructions,less processor time'
}

# Makes a reference once; delete build/results after a change of pictures.
reference() { # SCENE SAMPLES SIZE...
    local path=$cache/${1##*/}

    path=${path%.*}.pfm
    [ -e "$path" ] || "$build/glim" reference -s "$2" --seeds 16 "${@:3}" \
        "$path" "$1" 2>"$work/said"
    echo "$path"
}

# Error at doubling samples against processor time, and the slope.
measure_convergence() {
    local file path scene

    : >"$work/slopes"
    for file in $shipped; do
        scene=${file%.*}
        path=$(reference "scenes/$file" 16384 -w 64 -h 36)
        "$build/glim" curve -s 1024 --csv "$work/curve" "$path" \
            "scenes/$file" >"$work/said" 2>/dev/null
        sed -n "1d; s/^/$scene,/p" "$work/curve" | cut -d , -f 1-4,6
        {
            printf '%s,' "$scene"
            sed -n 's/^slope of log root relMSE over log cpu.*: \(.*\) (95 %: \(.*\) to \(.*\))/\1,\2,\3/p' \
                "$work/said"
        } >>"$work/slopes"
    done | save convergence 'scene,samples per pixel,seconds,processor seconds,relMSE'
    save slopes 'scene,slope,95 % interval from,to' <"$work/slopes"
}

# Sets obj, camera and reference to the files of a scene that all renderers
# read alike. glass_box and door_room are ours, so glim makes their references.
find_scene() { # SCENE
    local folder=$shared/scenes-bench/$1

    obj=$folder/$1.obj
    camera=$folder/camera.txt
    reference=$folder/reference.pfm
    case $1 in
    glass_box | door_room) ;;
    *) return 0 ;;
    esac
    folder=build/bench-error/scenes
    obj=$folder/$1.obj
    camera=$folder/$1.view
    reference=$(reference "$obj" 4096)
}

glim_row() { # SCENE SAMPLES NAME [--denoise]
    local out=$work/picture.pfm

    timed "$build/glim" -b -t 2 -s "$2" --stats "$work/stats" -o "$out" \
        "${@:4}" "$obj"
    echo "$1,$3,$2,$(value total_s "$work/stats"),$cpu_s,$(relmse "$out" \
        "$reference")"
}

cycles_row() { # SCENE SAMPLES NAME [--denoise]
    local out=$work/picture.pfm

    "$PEER" "$shared/lab/peers/render_cycles.py" -- --scene "$obj" \
        --camera "$camera" --spp "$2" --threads 2 --out "$out" "${@:4}" \
        >"$work/said" 2>&1
    sed -n 's/^RESULT //p' "$work/said" >"$work/stats"
    echo "$1,$3,$2,$(value render_s "$work/stats"),$(value cpu_s \
        "$work/stats"),$(relmse "$out" "$reference")"
}

# Time and error of glim, and of Blender's Cycles in the same minutes if PEER
# is set. glim's time includes loading, filtering and writing; Cycles' is that
# of its render call.
measure_peers() {
    local scene n obj camera reference header='scene,renderer,samples per pixel,seconds,processor seconds,relMSE'

    [ -d "$shared/scenes-bench" ] || {
        say "peers: skipped, no $shared/scenes-bench"
        return 0
    }
    [ -n "${PEER:-}" ] || say 'peers: without Cycles, since PEER is not set'
    : >"$work/cycles"
    for scene in cornell many_lights sky glass_box door_room; do
        find_scene $scene
        for n in 2 4 8 16 32 64 128 256; do
            glim_row $scene $n 'glim'
            glim_row $scene $n 'glim filtered' --denoise
            case $n in
            4 | 16 | 64)
                [ -z "${PEER:-}" ] || {
                    cycles_row $scene $n 'Cycles'
                    cycles_row $scene $n 'Cycles with OIDN' --denoise
                    cp "$work/stats" "$work/version"
                } >>"$work/cycles"
                ;;
            esac
        done
    done | save peers "$header"
    renderer="Cycles $(value version "$work/version")" save cycles "$header" \
        <"$work/cycles"
}

# The errors of raw pictures, of the filter and of Open Image Denoise, which
# gets the same pictures with their mean albedo and normals.
measure_oidn() {
    local scene n raw ours theirs obj camera reference

    if [ -z "${OIDN:-}" ] || [ ! -d "$shared/scenes-bench" ]; then
        say "oidn: skipped, OIDN is not set or $shared/scenes-bench is missing"
        return 0
    fi
    for scene in cornell many_lights sky glass_box; do
        find_scene $scene
        for n in 4 16 64 256; do
            "$build/bench/surfaces" "$obj" $n "$work/oidn"
            "$OIDN" tests/bench/results/oidn.py "$work/oidn"
            raw=$(relmse "$work/oidn_raw.pfm" "$reference")
            ours=$(relmse "$work/oidn_filtered.pfm" "$reference")
            theirs=$(relmse "$work/oidn_oidn.pfm" "$reference")
            echo "$scene,$n,$raw,$ours,$theirs"
        done
    done | save oidn 'scene,samples per pixel,relMSE raw,filtered by glim,by OIDN'
}

# Sets `log` to the output of `make stress`, or of one of its checks.
stress_log() { # [CHECK]
    log=${STRESS_LOG:-}
    [ -z "$log" ] || return 0
    log=$cache/stress${1:+_$1}.log
    say "runs make stress FILTER=${1:-}"
    FILTER=${1:-} tests/stress/run.sh >"$log" || :
}

# Counts of each check: its program, or the first word of its lines.
measure_stress() {
    stress_log
    awk '$1 == "--" { name = $2; next }
        /^(ok|FAIL) (C5|keys|oclgrind|valgrind)/ {
            name = $2 == "C5" ? "sizes" : $2
            sub(/,.*/, "", name)
        }
        /^(ok|FAIL) / {
            if (!(name in all)) order[++names] = name
            all[name]++
            if ($1 == "ok") ok[name]++
        }
        END { for (i = 1; i <= names; i++) {
            name = order[i]
            printf "%s,%d,%d\n", name, all[name], ok[name] } }' "$log" |
        save stress 'check,cases,passed'
}

measure_calibration() {
    stress_log error
    sed -n 's/^\(ok\|FAIL\) \([a-z_0-9]*\): \([a-z ]*\) at \([0-9.]*\) spp: \([0-9]*\) of \([0-9]*\) inside (\([0-9.]*\) .*error \([0-9.]*\) %.*true \([0-9.]*\) %.*/\2,\3,\4,\5,\6,\7,\8,\9/p' "$log" |
        awk -F, '{ printf "%s,%s,%s,%s %%,%s %%,%d,%s\n", $1, $2, $3, $7, $8, $5,
            ($5 < 100 ? "unresolved" : $6 " %") }' |
        save calibration 'scene,moment,samples per pixel,stated error,true error,resolved of 200,true error inside'
}

measure_filter() {
    stress_log filter
    sed -n 's#^\(ok\|FAIL\) filter: scenes/\([a-z_0-9]*\).obj, \([0-9]*\) spp: relMSE \([0-9.e+-]*\), filtered \([0-9.e+-]*\), own \([0-9.e+-]*\);.*#\2,\3,\4,\5,\6#p' "$log" |
        save filter 'scene,samples per pixel,relMSE raw,filtered,own error of the reference'
}

# Error of scenes with layers, special glass and caustics of the sun after 64
# samples, with all techniques and by the first integrator.
measure_surfaces() {
    local scene

    for scene in coat sheen grain film absorbing frosted sunball; do
        make -s bench-error ROUNDS=3 FILTER="$scene" >"$work/said"
        awk -F, '$3 == 64 { error[$2] = $5; s[$2] = $4 }
            END { a = "everything"; b = "first integrator"
                printf "%s,%.2g,%.2f,%.2g,%.2f\n", scene, error[a], s[a],
                    error[b], s[b] }' scene="$scene" build/bench-error/error.csv |
            sed "s/\$/,$(sed -n "s/^$scene  *\([0-9.e+]*\) times.*/\1/p" \
                "$work/said")/"
    done | save surfaces 'scene,relMSE,seconds,relMSE of the first integrator,seconds,error lower by'
}

measure_blender() {
    stress_log blender
    sed -En 's/^(ok|FAIL) //
        s/^Blender ([0-9.]+)[^,]* ([a-z_]+), ([a-z ]+): ball ([0-9. ]+), Cycles ([0-9. ]+): differs by ([0-9.]+ %), floor by ([0-9.]+ %)( \((.*)\))?$/\2,\3,\1,\4,\5,\6,\7,\9/p' "$log" |
        save blender 'material,export,Blender,ball by glim,by Cycles,ball differs,floor differs,why'
}

machine=$(machine)
case " $sections none " in
*" ${filter:-none} "*) ;;
*)
    say "found no section '$filter', expected one of $sections none" >&2
    exit 2
    ;;
esac
for section in $sections; do
    [ -z "$filter" ] || [ "$filter" = "$section" ] || continue
    say "$section"
    "measure_$section"
done
