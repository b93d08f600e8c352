// SPDX-License-Identifier: MIT
/*
 * option_help.h - the text of --help, made from the tables of options and
 * sub-commands
 *
 * Threads:   main only
 * Errors:    those of the stream, which its owner has to check
 */
#ifndef GLIM_OPTION_HELP_H
#define GLIM_OPTION_HELP_H

#include <stdio.h>

void option_help_print(FILE *to);

#endif
