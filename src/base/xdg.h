// SPDX-License-Identifier: MIT
/*
 * xdg.h - folders for files of the user, by the XDG base directory
 * specification
 *
 * Ownership: memory for free() is returned
 * Threads:   main only, as getenv()
 * Errors:    NULL where there is no such folder
 */
#ifndef GLIM_XDG_H
#define GLIM_XDG_H

/* Returns the folder glim in the folder that the variable names, or in
 * ~/BELOW_HOME. It need not exist. Relative names in the variable are ignored,
 * as the specification says. */
char *xdg_folder(const char *variable, const char *below_home);

/* Returns the path of a file in the folder of XDG_STATE_HOME, or in
 * ~/.local/state. Makes the folder if necessary. */
char *xdg_state_path(const char *name);

#endif
