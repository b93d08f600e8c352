#!/bin/sh
# SPDX-License-Identifier: MIT
# layers.sh - checks the order of folders and the form of files
#
# The order of the folders is that of the table in CONTRIBUTING.md ("|
# `src/world/bvh/` | ..."): a file includes from its own folder and from those above
# it. The files of src/ itself come last. Prints a line for each violation, then
# "layers: N passed, N failed" counted in files.
set -u
cd "$(dirname "$0")/.." || exit 1

{
    find include src kernels scenes tests -name '*.[ch]' -o -name '*.c[lc]'
    find kernels scenes tests .ci -name '*.sh' -o -path .ci/run
} | sort | awk '
function fault(text)
{
    printf "%s: %s\n", path, text
    faults[path] = 1
}

function stem_of(name)
{
    sub(/.*\//, "", name)
    sub(/\.(c|cc|h)$/, "", name)
    return name
}

function folder_of(name)
{
    return name ~ /\// ? substr(name, 1, match(name, /\/[^\/]*$/) - 1) : "."
}

# Returns the position of a folder in the table, from 1; 0 if it is not there.
function place_of(folder)
{
    return folder == "src" ? folder_count + 1 : places[folder] + 0
}

# Reads the third column: headers, each after the files that alone include it,
# or after none if the whole folder does. A header that ends with / is a folder.
function read_exclusive(folder, column,    entry, name, count, i, k, n)
{
    n = split(column, entry, ";")
    for (i = 1; i <= n; i++) {
        count = split(entry[i], name, "`")
        if (count < 3)
            continue
        if (count == 3)
            owners[name[2]] = owners[name[2]] " " folder "/*"
        for (k = 2; k < count - 1; k += 2)
            owners[name[count - 1]] = owners[name[count - 1]] " " folder "/" name[k]
    }
}

function check_exclusive(name,    header, own)
{
    own = path
    sub(/\.[a-z]+$/, "", own)
    for (header in owners)
        if ((name == header || (header ~ /\/$/ && index(name, header) == 1)) &&
            index(owners[header] " ", " " own " ") == 0 &&
            index(owners[header] " ", " " folder "/* ") == 0)
            fault("only" owners[header] " include " name)
}

function read_table(    line, cell, part)
{
    while ((getline line < "CONTRIBUTING.md") > 0) {
        if (line !~ /^\| `(include\/glim|kernels|src\/[a-z]+(\/[a-z]+)?)\/` \|/)
            continue
        split(line, cell, "|")
        split(cell[2], part, "`")
        sub(/\/$/, "", part[2])
        places[part[2]] = ++folder_count
        read_exclusive(part[2], cell[4])
    }
    if (folder_count < 5) {
        print "CONTRIBUTING.md: the table of folders was not found"
        exit 1
    }
}

function check_include(name, is_system,    kernel, other)
{
    kernel = path ~ /^kernels\//
    if (!kernel)
        check_exclusive(name)
    if (is_system) {
        if (folder == "include/glim" && name !~ /^std(bool|def|int)\.h$/)
            fault("the public header includes only stdbool, stddef and stdint")
        if (kernel && stem != "dialect")
            fault("kernels include libc only in dialect.h: <" name ">")
        return
    }
    if (kernel && name !~ /^kernels\//)
        fault("kernels include only kernels: \"" name "\"")
    other = name ~ /^kernels\// ? "kernels" : \
            name ~ /^glim\// ? "include/glim" : "src/" folder_of(name)
    if (other == "src/.")
        other = folder
    if (place_of(other) == 0)
        fault("in no folder of the table in CONTRIBUTING.md: \"" name "\"")
    else if (place_of(other) > place_of(folder))
        fault(other " comes after " folder " in the table: \"" name "\"")
}

function check_folder()
{
    if (place_of(folder) == 0)
        fault("is in no folder of the table in CONTRIBUTING.md")
}

# Foreign text reaches a terminal through print.c and add_columns() alone. Files
# are written to streams that are called `to`; folders before src/terminal know
# no others.
function check_output(line, number)
{
    if (line ~ /^ *(\/\*|\*)/)
        return
    if (line ~ /(^|[^a-z_A-Z0-9])(v?printf|puts|putchar|perror|psignal|v?dprintf)\(/)
        fault("line " number ": people read what print.h writes")
    if (line !~ /\([sw]?[->.]*to,|, [sw]?[->.]*to\)/ &&
        place_of(folder) >= place_of("src/terminal") &&
        (line ~ /(^|[^a-z_A-Z0-9])(v?fprintf|fputs|putc|fwrite)\(/ ||
         line ~ /(^|[^a-z_A-Z0-9])fputc\([^\047]/))
        fault("line " number ": only files are written without print.h")
    if (line ~ /(add|ins)n?w?str\(|printw\(|addw?ch\(|add_wch\(/ &&
        line !~ /^    waddstr\(to, line\);$/)
        fault("line " number ": texts of windows go through add_columns()")
}

function check_file(    line, number, head, is_ours, is_licensed)
{
    stem = stem_of(path)
    folder = folder_of(path)
    is_ours = path ~ /^(include|src|kernels)\//
    if (is_ours)
        check_folder()
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
        if (line ~ /(^|[^a-z_A-Z0-9])_?exit\(/ && path !~ /^src\/(main|base\/stop|terminal\/xmalloc)\.c$/)
            fault("line " number ": only main ends the program")
        if (line ~ /(^|[^a-z_A-Z0-9])(stdin|stdout|stderr|STDERR_FILENO)([^a-z_A-Z0-9]|$)/ &&
            line !~ /^ *(\/\*|\*)/ && place_of(folder) < place_of("src/terminal"))
            fault("line " number ": a library leaves its caller\047s streams alone")
        if (line ~ /(^|[^a-z_A-Z0-9])v?fork\(/)
            fault("line " number ": OpenCL does not survive fork: posix_spawn")
    }
    close(path)
    if (!is_licensed)
        fault("does not begin with the SPDX line")
    if (path ~ /\.h$/) {
        if (head !~ "\n \\* " stem "\\.h - ")
            fault("the head comment does not say what it is")
        if (head ~ /\n \* (Units|Ownership|Threads|Errors): *none\n/)
            fault("the head has a line that only says none")
    }
}

BEGIN {
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
