#!/bin/sh
# SPDX-License-Identifier: MIT
# links.sh - finds files that Markdown files link to and that do not exist, and
# pictures of docs/results/ that docs/results.md does not show
set -u
cd "$(dirname "$0")/.." || exit 1
status=0

for text in *.md docs/*.md tests/*.md tests/bench/*.md; do
    for link in $(grep -oE '\]\([^)# ]+' "$text" | cut -c 3- | grep -v '://'); do
        [ -e "$(dirname "$text")/$link" ] || {
            echo "$text: found the link $link, expected a file"
            status=1
        }
    done
done
for picture in docs/results/*.png; do
    grep -q "(results/${picture##*/})" docs/results.md || {
        echo "$picture: expected docs/results.md to show it"
        status=1
    }
done
exit $status
