# SPDX-License-Identifier: MIT
# Allocations, threads and system calls that fail leave a right picture or one
# line that says why there is none. `make stress` lets all of them fail.
library=$(dirname "$(command -v glim)")/faults/fault.so
[ -e "$library" ] || skip 'no faults with sanitizers'
for run in cornell film; do
    BUILD=${library%/faults/*} FILTER=$run "$root/tests/faults/run.sh" 90 >rows ||
        echo "exit $?"
    grep -v '^ok \|^skip ' rows
    grep -c '^ok ' rows | sed 's/^[2-9]$/some rows are right/'
done
