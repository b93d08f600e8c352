// SPDX-License-Identifier: MIT
#include "base/text_stream.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

/* Keeps room for the zero at the end. */
static ssize_t put(void *stream, const char *bytes, size_t size_bytes)
{
    struct text_stream *s = stream;

    if (s->lacks_memory || !grow_array(&s->text, &s->capacity,
                                       s->size_bytes + size_bytes + 1, 1)) {
        s->lacks_memory = true;
        return 0;
    }
    memcpy((char *)s->text + s->size_bytes, bytes, size_bytes);
    s->size_bytes += size_bytes;
    return (ssize_t)size_bytes;
}

bool text_stream_open(struct text_stream *s)
{
    *s = (struct text_stream){.to = NULL};
    s->lacks_memory = !grow_array(&s->text, &s->capacity, 1, 1);
    if (!s->lacks_memory)
        s->to = fopencookie(s, "w", (cookie_io_functions_t){.write = put});
    return s->to != NULL;
}

char *text_stream_close(struct text_stream *s, size_t *size_bytes)
{
    char *text;

    if (s->to == NULL || fclose(s->to) != 0 || s->lacks_memory) {
        free(s->text);
        return NULL;
    }
    text = s->text; /* may have moved */
    text[s->size_bytes] = '\0';
    *size_bytes = s->size_bytes;
    return text;
}

bool text_stream_write(struct text_stream *s, const char *path,
                       struct error *err)
{
    size_t size_bytes;
    char *text = text_stream_close(s, &size_bytes);
    bool ok = text != NULL
                  ? file_write(path, text, size_bytes, false, NULL, err)
                  : fail(err, "%s: out of memory", path);

    free(text);
    return ok;
}
