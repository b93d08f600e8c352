#!/bin/sh
# SPDX-License-Identifier: MIT
# turns.sh - speed on one thread beside that of another commit, in turns
#
# usage: turns.sh GLIM COMMIT
#
# Builds the commit in build/turns/. A ratio above 1 says that GLIM is faster.
# The least time of some rounds is that of the calmest moments; the median of
# the rounds' ratios says how calm the machine is.
set -eu
glim=$1
commit=$(git rev-parse --short "$2^{commit}")
tree=build/turns/$commit
rounds=${ROUNDS:-7}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ ! -e "$tree" ]; then
    git worktree prune
    git worktree add --quiet --detach "$tree" "$commit"
fi
make -s -C "$tree" all

# seconds GLIM SCENE: prints seconds of rendering
seconds() {
    "$1" -b -t 1 -w 480 -h 270 -s 8 --stats "$work/stats" \
        -o "$work/picture.pfm" "$2" 2>"$work/messages"
    sed -n 's/.*"render_s": *\([0-9.]*\).*/\1/p' "$work/stats"
}

printf '%-28s %9s %9s %9s %9s\n' "against $commit" 'then' now fastest median
for scene in cornell lights200 skylit glass_mirror materials interior; do
    scene=$tree/scenes/$scene.obj
    : >"$work/rounds"
    for _ in $(seq "$rounds"); do
        then=$(seconds "$tree/build/release/glim" "$scene")
        now=$(seconds "$glim" "$scene")
        awk "BEGIN { print $then / $now, $then, $now }" >>"$work/rounds"
    done
    sort -n "$work/rounds" | awk -v name="${scene#"$tree"/}" '
        { ratio[NR] = $1
          if (NR == 1 || $2 < a) a = $2
          if (NR == 1 || $3 < b) b = $3 }
        END { printf "%-28s %9.3f %9.3f %9.3f %9.3f\n", name, a, b, a / b,
                     ratio[int((NR + 1) / 2)] }'
done
