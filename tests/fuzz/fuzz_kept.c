// SPDX-License-Identifier: MIT
/*
 * Kept sessions: what is read is written and read again with the same parts.
 * Any bytes can be parts.
 */
#include "fuzz.h"
#include "session/autosave_file.h"

/* Writes a session and reads it again. */
static void check(const struct autosave_file *k)
{
    struct autosave_file back;
    struct error err = {""};
    size_t size;
    char *bytes = autosave_file_bytes(k, &size);

    require(bytes != NULL, "memory");
    bytes[size] = '\0';
    require(autosave_file_parse(&back, "b.session", bytes, size, &err),
            err.text);
    require(strcmp(k->scene, back.scene) == 0, "the scene");
    require(k->render_ns == back.render_ns, "the time");
    for (int i = 0; i < AUTOSAVE_PARTS; i++) {
        require(k->sizes[i] == back.sizes[i], "a size");
        require(memcmp(k->parts[i], back.parts[i], k->sizes[i]) == 0, "a part");
    }
    autosave_file_free(&back);
    free(bytes);
}

/* Takes quarters of the text as parts. */
static void try_parts(char *text, size_t size)
{
    char scene[] = "/s.obj";
    struct autosave_file k = {.scene = scene, .render_ns = size};

    for (size_t i = 0; i < AUTOSAVE_PARTS; i++) {
        k.parts[i] = text + i * (size / AUTOSAVE_PARTS);
        k.sizes[i] = size / AUTOSAVE_PARTS;
    }
    check(&k);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    struct autosave_file k;
    struct error err = {""};

    require(text != NULL, "memory");
    memcpy(text, data, size);
    text[size] = '\0';
    if (autosave_file_parse(&k, "a.session", text, size, &err))
        check(&k);
    else
        fuzz_check_message(err.text);
    autosave_file_free(&k);
    try_parts(text, size);
    free(text);
    return 0;
}
