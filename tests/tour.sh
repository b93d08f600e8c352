#!/bin/sh
# SPDX-License-Identifier: MIT
# tour.sh - finds files and functions of docs/tour.md that do not exist
set -u
cd "$(dirname "$0")/.." || exit 1
status=0
steps=$(grep -c '^[0-9]*\. `' docs/tour.md)

for file in $(grep -oE '`(src|kernels)/[a-z0-9_/]*\.[ch]`' docs/tour.md | tr -d '`')
do
    [ -f "$file" ] || {
        echo "docs/tour.md: found $file, expected a file"
        status=1
    }
done
while read -r file name; do
    grep -qE "\b$name\(" "$file" || {
        echo "docs/tour.md: found $name(), expected a function of $file"
        status=1
    }
done <<END
$(sed -nE 's/^[0-9]+\. `([^`]*)` `([a-z0-9_]*)\(\)`.*/\1 \2/p' docs/tour.md)
END
[ "$steps" -gt 0 ] && [ "$steps" -le 15 ] || {
    echo "docs/tour.md: found $steps steps, expected 1 to 15"
    status=1
}
exit $status
