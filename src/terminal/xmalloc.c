// SPDX-License-Identifier: MIT
#include "terminal/xmalloc.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"

/* set before the threads start */
static void (*restore_terminal)(void);

/* Ends the program without atexit functions or stdio, since other threads may
 * be running. */
static _Noreturn void out_of_memory(void)
{
    static const char text[] = "glim: out of memory\n";

    if (restore_terminal)
        restore_terminal();
    ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
    (void)written; /* errors cannot be reported here */
    _exit(1);
}

void xmalloc_set_hook(void (*hook)(void))
{
    restore_terminal = hook;
}

void *xchecked(void *p)
{
    if (!p)
        out_of_memory();
    return p;
}

void xcheck(bool has_memory)
{
    if (!has_memory)
        out_of_memory();
}

void *xmalloc(size_t size_bytes)
{
    return xchecked(malloc(size_bytes ? size_bytes : 1));
}

void *xcalloc(size_t count, size_t size_bytes)
{
    return xchecked(alloc_array(count, size_bytes));
}

void *xrealloc(void *p, size_t size_bytes)
{
    return xchecked(realloc(p, size_bytes ? size_bytes : 1));
}

char *xstrdup(const char *s)
{
    return xchecked(strdup(s));
}

char *xformat(const char *format, ...)
{
    va_list values;
    char *text;

    va_start(values, format);
    text = format_list(format, values);
    va_end(values);
    return xchecked(text);
}
