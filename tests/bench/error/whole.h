// SPDX-License-Identifier: MIT
/*
 * whole.h - replaces nothing; the build has the same instruction set as those
 * with a function replaced
 */
