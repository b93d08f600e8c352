# SPDX-License-Identifier: MIT
# --help and --version go to standard output, whatever else is on the line.
glim --help | sed -n '1,2p'
glim --help 2>/dev/null | wc -l | awk '{ print ($1 > 20 ? "long" : "short") }'
run --version | sed 's/[0-9][0-9.]*$/N/'
run -w x --version
run --version -w x | sed 's/[0-9][0-9.]*$/N/'
glim --help | awk 'length > 80 { print "too wide: " $0 }'
if [ -e /dev/full ]; then
    glim --help 2>&1 >/dev/full
    echo "exit $?"
fi
