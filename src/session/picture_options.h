// SPDX-License-Identifier: MIT
/*
 * picture_options.h - the options with which a saved picture was rendered, from
 * the texts in its file
 *
 * Ownership: strings of the options are allocated once
 * Threads:   main only
 * Errors:    an unreadable file, one without such texts, a missing scene
 */
#ifndef GLIM_PICTURE_OPTIONS_H
#define GLIM_PICTURE_OPTIONS_H

#include "session/command_line.h"

/* Parses argv again, over the options of o->picture_path, over those in
 * *before. If no scene is given, it is the one of its name beside the picture,
 * or else in the current folder. */
bool picture_options_parse(struct options *o, const struct options *before,
                           int argc, char **argv, struct error *err);

#endif
