# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# pool.sh - runs commands side by side; sourced by the scripts that run tests

# Starts the command in the background when fewer than JOBS (one for each
# processor) are running.
in_pool()
{
    while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-$(nproc)}" ]; do
        wait -n
    done
    "$@" &
}
