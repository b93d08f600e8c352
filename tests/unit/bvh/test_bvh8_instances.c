// SPDX-License-Identifier: MIT
/* This file is built for several instruction sets; ISA is the name of the
 * set. */
#include "bvh/bvh8_traverse.h"
#include "render/cpu_dispatch.h"

#include "tests/unit/instance_rays.h"

#ifndef ISA
#define ISA "plain"
#endif

int main(void)
{
    struct error err;

    return cpu_kernel_named(ISA, &err) != NULL ? run_instance_rays() : 0;
}
