#!/bin/sh
# SPDX-License-Identifier: MIT
# layers.sh - says which file breaks the layers or the look of files
#
# The rows come from the table in CONTRIBUTING.md ("| 2 | `scene bvh ...` |"):
# a file includes from its own row and those with lower numbers. Prints a line
# for each fault, then "layers: N passed, N failed" counted in files.
set -u
cd "$(dirname "$0")/.." || exit 1

# The C files that have no header of their own name: the program's entry, the
# bodies of stb's headers, and what backend.h declares.
HEADERLESS='main stb backend_cpu'

# The files that may use the C library's output: what they write are files'
# texts. People read what goes through print.c.
WRITERS='print assign mtl_save view_file cl_source stats windows'

{
    find src include kernels scenes tests -name '*.[ch]' -o -name '*.cl'
    find kernels scenes tests .ci -name '*.sh' -o -path .ci/run
} | sort | awk -v headerless="$HEADERLESS" -v writers="$WRITERS" '
function fault(text)
{
    printf "%s: %s\n", path, text
    faults[path] = 1
}

function stem_of(name)
{
    sub(/.*\//, "", name)
    sub(/\.[ch]$/, "", name)
    return name
}

# kernels are row 0; the rest is as the table says, -1: not in it
function row_of(name)
{
    if (name ~ /^kernels\//)
        return 0
    return stem_of(name) in rows ? rows[stem_of(name)] : -1
}

function read_table(    line, row, cell, words, n, i)
{
    while ((getline line < "CONTRIBUTING.md") > 0) {
        if (line !~ /^\| [0-9] \|/)
            continue
        split(line, cell, "|")
        row = cell[2] + 0
        gsub(/`/, "", cell[3])
        n = split(cell[3], words, " ")
        for (i = 1; i <= n; i++)
            rows[words[i]] = row
        table_rows++
    }
    if (table_rows < 5) {
        print "CONTRIBUTING.md: the table of rows was not found"
        exit 1
    }
}

function check_include(name, is_system,    kernel)
{
    kernel = path ~ /^kernels\//
    if (is_system) {
        if (kernel && stem != "dialect")
            fault("kernels include libc only in dialect.h: <" name ">")
        if (name ~ /curses|^term(info|cap)?\.h$/ && stem !~ /^(term|windows)$/)
            fault("only term and windows include <" name ">")
        if (name ~ /^CL\// && stem !~ /^(cl_.*|backend_cl)$/)
            fault("only cl_* and backend_cl include <" name ">")
        return
    }
    if (kernel && name !~ /^kernels\//)
        fault("kernels include only kernels: \"" name "\"")
    if (name == "kernels/path.h" && stem !~ /^(paths|trail|first_hits)$/ && !kernel)
        fault("only cpu_kernel.c, path_record.c and aov_picture.c include kernels/path.h")
    if (name ~ /^(glim|kernels)\// && row_of(name) > row_of(path) &&
        row_of(path) >= 0)
        fault("row " row_of(path) " includes \"" name "\" of row " \
              row_of(name))
}

function check_rows(    line)
{
    if (path ~ /^src\/.*\.c$/ && !(stem in exempt) &&
        (getline line < ("include/glim/" stem ".h")) < 0)
        fault("has no include/glim/" stem ".h")
    close("include/glim/" stem ".h")
    if (row_of(path) < 0)
        fault("is in no row of the table in CONTRIBUTING.md")
}

# foreign text reaches a terminal through print.c and add_columns() alone
function check_output(line, number)
{
    if (line ~ /^ *(\/\*|\*)/)
        return
    if (line ~ /(^|[^a-z_A-Z0-9])(v?printf|puts|putchar|perror|psignal|v?dprintf)\(/)
        fault("line " number ": people read what print.h writes")
    if (!(stem in writer) &&
        (line ~ /(^|[^a-z_A-Z0-9])(v?fprintf|fputs|putc|fwrite)\(/ ||
         line ~ /(^|[^a-z_A-Z0-9])fputc\([^\047]/))
        fault("line " number ": only writers of files do without print.h")
    if (line ~ /(add|ins)n?w?str\(|printw\(|addw?ch\(|add_wch\(/ &&
        line !~ /^    waddstr\(to, line\);$/)
        fault("line " number ": texts of windows go through add_columns()")
}

function check_file(    line, number, head, is_ours, is_licensed)
{
    stem = stem_of(path)
    is_ours = path ~ /^(src|include|kernels)\//
    if (is_ours)
        check_rows()
    while ((getline line < path) > 0) {
        number++
        if (number <= 2 && line ~ /^(\/\/|#) SPDX-License-Identifier: MIT$/)
            is_licensed = 1
        if (number <= 40)
            head = head "\n" line
        if (!is_ours)
            continue
        if (path ~ /^src\//)
            check_output(line, number)
        if (line ~ /^[ \t]*#[ \t]*include[ \t]*"/) {
            split(line, part, "\"")
            check_include(part[2], 0)
        } else if (line ~ /^[ \t]*#[ \t]*include[ \t]*</) {
            split(line, part, /[<>]/)
            check_include(part[2], 1)
        }
        if (line ~ /(^|[^a-z_A-Z0-9])(atoi|atol|atof|strtok)\(/)
            fault("line " number ": atoi, atof and strtok hide errors")
        if (line ~ /(^|[^a-z_A-Z0-9])_?exit\(/ && path !~ /^src\/(main|util)\.c$/)
            fault("line " number ": only main ends the program")
        if (line ~ /(^|[^a-z_A-Z0-9])v?fork\(/)
            fault("line " number ": OpenCL does not survive fork: posix_spawn")
    }
    close(path)
    if (!is_licensed)
        fault("does not begin with the SPDX line")
    if (path ~ /\.h$/) {
        if (head !~ "\n \\* " stem "\\.h - ")
            fault("the head comment does not say what it is")
        if (head !~ /Units: .*Ownership: .*Threads: .*Errors: /)
            fault("the head lacks Units, Ownership, Threads or Errors")
    }
}

BEGIN {
    n = split(headerless, list, " ")
    for (i = 1; i <= n; i++)
        exempt[list[i]] = 1
    n = split(writers, list, " ")
    for (i = 1; i <= n; i++)
        writer[list[i]] = 1
    read_table()
}

{
    path = $0
    check_file()
    if (path in faults)
        failed++
    else
        passed++
}

END {
    printf "layers: %d passed, %d failed\n", passed, failed
    exit failed > 0 || passed == 0
}'
