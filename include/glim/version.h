// SPDX-License-Identifier: MIT
/*
 * version.h - the one place that has the version
 *
 * The shared library's name ends with GLIM_VERSION_MAJOR: it grows when a
 * program that was built with an older header no longer works.
 */
#ifndef GLIM_VERSION_H
#define GLIM_VERSION_H

#define GLIM_VERSION_MAJOR 0
#define GLIM_VERSION_MINOR 1
#define GLIM_VERSION_PATCH 0
#define GLIM_VERSION       "0.1.0"

#endif
