// SPDX-License-Identifier: MIT
/*
 * sub_command.h - sub-commands: their names, operands and options
 *
 * Ownership: strings point into argv
 * Threads:   main only
 * Errors:    a missing operand or one too many
 */
#ifndef GLIM_SUB_COMMAND_H
#define GLIM_SUB_COMMAND_H

#include "session/option_set.h"

struct sub_command_rule {
    const char *name;     /* after a blank */
    const char *operands; /* and options that it needs, for messages */
    const char *help;
};

/* Returns the rule of sub-command i, from 0 on; NULL after the last. */
const struct sub_command_rule *sub_command_rule(int i);

/* Returns the sub-command of this name, COMMAND_RENDER if there is none. */
enum sub_command sub_command_named(const char *name);

/* Returns the name of a sub-command after a blank; "" for COMMAND_RENDER. */
const char *sub_command_name(enum sub_command command);

/* Returns true if the sub-command takes the option. */
bool sub_command_takes(enum sub_command command, enum option_id id);

/* Sets the next file that is given without an option: the scene, or a picture
 * of a sub-command. */
bool sub_command_set_operand(struct options *o, const char *path,
                             struct error *err);

/* Checks the operands and options of a sub-command together. */
bool sub_command_check(struct options *o, struct error *err);

#endif
