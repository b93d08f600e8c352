// SPDX-License-Identifier: MIT
#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/print.h"

bool fail(struct error *err, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    print_replace(err->text);
    return false;
}

void error_add(struct error *err, const struct error *more)
{
    size_t length = strlen(err->text);

    snprintf(err->text + length, sizeof err->text - length, "; %s", more->text);
}
