#!/bin/bash
# SPDX-License-Identifier: MIT
# check.sh - finds mutants of tests/mutants/list that change nothing, because the
# source has changed since, or that name no test
set -u
cd "$(dirname "$0")/../.." || exit 1
status=0

while IFS='|' read -r name file change test; do
    case $name in
    '' | '#'*) continue ;;
    esac
    # unquoted: without the spaces around them
    file=$(echo $file) test=$(echo $test)
    if [ ! -f "$file" ] || sed "$change" "$file" | cmp -s - "$file"; then
        echo "tests/mutants/list: $name: found nothing to change in $file"
        status=1
    fi
    if [ ! -f "tests/unit/$test.c" ]; then
        echo "tests/mutants/list: $name: found $test, expected a unit test"
        status=1
    fi
done <tests/mutants/list
exit $status
