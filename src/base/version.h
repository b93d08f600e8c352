// SPDX-License-Identifier: MIT
/*
 * version.h - the one place that has the version
 */
#ifndef GLIM_VERSION_H
#define GLIM_VERSION_H

#define GLIM_VERSION "0.1.0"

#endif
