# SPDX-License-Identifier: MIT
# --help and --version print to standard output in spite of other arguments.
glim --help | sed -n '1,2p'
glim --help 2>/dev/null | wc -l | awk '{ print ($1 > 20 ? "long" : "short") }'
run --version | sed 's/ [0-9][0-9.]*$/ N/; s/isa: .*plain$/isa: all/'
run -w x --version
run --version -w x | sed 's/ [0-9][0-9.]*$/ N/; s/isa: .*plain$/isa: all/'
glim --help | awk 'length > 80 { print "too wide: " $0 }'
if [ -e /dev/full ]; then
    glim --help 2>&1 >/dev/full
    echo "exit $?"
fi
# an instruction set that no processor has
take box
run -b --isa sse9 -o x.png box.obj | sed "s/: [a-z0-9, ]*plain$/: all/"
