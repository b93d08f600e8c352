#!/bin/sh
# SPDX-License-Identifier: MIT
# embed.sh - writes C source that contains the named files, see cl_source.h
set -eu

echo "#include <stddef.h>"
echo
echo '#include "render/opencl/cl_source.h"'
# arrays of numbers, since compilers may limit strings to 4095 characters
i=0
for file; do
    i=$((i + 1))
    echo "static const unsigned char text_$i[] = {"
    od -A n -v -t u1 "$file" | sed 's/[0-9]\{1,\}/&,/g'
    echo '0};'
done
echo 'const struct cl_source_file cl_source_files[] = {'
i=0
for file; do
    i=$((i + 1))
    echo "{\"$file\", (const char *)text_$i},"
done
echo '{NULL, NULL}};'
