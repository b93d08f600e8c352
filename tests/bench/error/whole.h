// SPDX-License-Identifier: MIT
/*
 * whole.h - for paths as they are, built for the same instructions as those
 * that have a function replaced
 */
