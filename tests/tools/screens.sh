#!/bin/bash
# SPDX-License-Identifier: MIT
# screens.sh - takes the pictures of docs/screens.md: runs the program in a real
# xterm on a virtual display, presses keys and saves the window
#
# GLIM is the program, OUT the folder for the pictures. Needs xvfb, xterm,
# xdotool, imagemagick and fonts-dejavu-core.
set -u
out=${OUT:-docs/screens}
glim=$(realpath "${GLIM:-build/release/glim}")
display=:93

for program in Xvfb xterm xdotool import convert; do
    command -v "$program" >/dev/null || {
        echo "screens: found no $program, expected the packages xvfb, xterm," \
            "xdotool and imagemagick"
        exit 1
    }
done
mkdir -p "$out"
home=$(mktemp -d)
mkdir "$home/models"
cp scenes/materials.* scenes/*.png "$home/models/"
trap 'kill $server $terminal 2>/dev/null; rm -rf "$home"' EXIT
terminal=
Xvfb $display -screen 0 1600x1200x24 >/dev/null 2>&1 &
server=$!
export DISPLAY=$display
sleep 1

# Screens: name, seconds to wait before the picture, keys before it.
steps='
live 5
panel 1.5 Tab Down Down Down Down Down
values 1 Return Down Down Left Left Left
objects 1.5 Escape Tab Down Down
light 1 Tab
help 1 Escape question
search 1 n o i s e
open 1.5 Escape Escape O
views 1 Escape k 1 apostrophe
about 4 Escape g
compare 1.5 g K Tab Tab Down Down Down Down Down Down Return Down Down parenleft parenleft parenleft parenleft Escape Escape
differences 5 y
normals 2 Escape n n
path 2 N N t t t greater greater
boxes 1.5 t t t greater greater greater
question 1 t t t t ctrl+q
menu 1 n Escape
normal 3 Escape space Return
'

# Presses keys and saves the window of the terminal.
take()
{
    name=$1
    pause=$2
    shift 2
    for key; do
        xdotool key --window "$window" "$key"
        sleep 0.15
    done
    sleep "$pause"
    import -window "$window" "$home/shot.png" &&
        convert "$home/shot.png" -strip +dither -colors 256 -define png:compression-level=9 \
            "PNG8:$out/$name-$theme-$size.png"
}

run()
{
    theme=$1
    size=$2
    rm -rf "$home/glim" # the session that the last run has left
    rm -f "$home"/models/*~
    colors="-bg black -fg gray85"
    [ "$theme" = light ] && colors="-bg white -fg black"
    # shellcheck disable=SC2086 # several words
    HOME=$home XDG_CONFIG_HOME=$home XDG_STATE_HOME=$home XDG_CACHE_HOME=$home \
        COLORTERM=truecolor xterm -fa 'DejaVu Sans Mono' -fs 10 $colors +sb \
        -b 0 -geometry "$size" -title glim-screens \
        -e "cd '$home/models' && '$glim' -t 2 materials.obj" &
    terminal=$!
    window=$(xdotool search --sync --onlyvisible --name glim-screens | tail -n 1)
    xdotool windowmove "$window" 0 0 windowfocus "$window"
    echo "$steps" | while read -r name pause keys; do
        # shellcheck disable=SC2086 # one word a key
        [ -n "$name" ] && take "$name" "$pause" $keys
    done
    kill $terminal
    wait $terminal 2>/dev/null
}

for theme in ${THEMES:-dark light}; do
    for size in ${SIZES:-80x24 160x50}; do
        run $theme $size
    done
done
echo "screens: $(find "$out" -name '*.png' | wc -l) pictures in $out"
