# SPDX-License-Identifier: MIT
# Impossible cameras are refused with the line; unusual ones are accepted.
take box
try()
{
    printf "$1" >my.view
    run_untimed -b -w 8 -h 4 -s 1 -o out.png -c my.view box.obj
}
for angle in 0 180 -10 nan 1e400 wide; do
    try "eye 0 1 4\nat 0 1 0\nfovy $angle\n"
done
try 'eye 0 1 4\nat 0 1 4\n'
try 'eye 0 1\nat 0 1 4\n'
try 'res 0 4\n'
try 'res 8 70000\n'
try 'eye 0 1 4\nat 0 1 0\nup 0 0 0\n'
echo 'these work:'
try 'eye 0 1 4\nat 0 1 0\nfovy 179.9\n'
try 'eye 0 4 0\nat 0 1 0\nup 0 1 0\n'
try 'eye 0 0 0.5\nat 0 1 0\n'
try 'spin 3\n'
