// SPDX-License-Identifier: MIT
/*
 * The file beside a reference: what was read is written, with the input as the
 * name of the scene, and read again. Both have the same numbers. The written
 * name is a string of JSON.
 */
#include <math.h>

#include "base/file.h"
#include "command/reference_info.h"
#include "fuzz.h"
#include "mutate_text.h"

/* Numbers are written with six digits. */
static int is_same(double a, double b)
{
    return fabs(a - b) <= 1e-5 * fabs(a) + 1e-300;
}

static void check_same(const struct reference_info *a,
                       const struct reference_info *b)
{
    require(b->is_known, "an error");
    require(is_same(a->mse, b->mse) && is_same(a->relmse, b->relmse) &&
                is_same(a->relmse_low, b->relmse_low) &&
                is_same(a->relmse_high, b->relmse_high),
            "the error");
}

static void check_numbers(const struct reference_info *info)
{
    require(isfinite(info->mse) && info->mse >= 0, "an error");
    require(isfinite(info->relmse) && info->relmse >= 0, "an error");
    require(isfinite(info->relmse_low) && isfinite(info->relmse_high),
            "an interval");
    require(isfinite(info->first_seed) && isfinite(info->seed_count), "seeds");
}

/* Returns the end of the JSON string at p. */
static const char *skip_string(const char *p)
{
    require(*p == '"', p);
    for (p++; *p != '"';) {
        int count = fuzz_character_bytes((const unsigned char *)p);

        require(count > 0 && (unsigned char)*p >= ' ' && *p != 0x7f, p);
        if (*p == '\\') {
            static const char hex[] = "0123456789abcdef";
            size_t escape = strspn(p + 2, hex);

            require(p[1] == '"' || p[1] == '\\' || (p[1] == 'u' && escape >= 4),
                    p);
            count = p[1] == 'u' ? 6 : 2;
        }
        p += count;
    }
    return p + 1;
}

static void check_written(const char *path)
{
    static const char key[] = "\"scene\": ";
    struct error err = {""};
    const char *scene;
    char *text;
    size_t size;

    require(file_read(path, &text, &size, &err), err.text);
    scene = strstr(text, key);
    require(scene != NULL, text);
    scene = skip_string(scene + strlen(key));
    require(strncmp(scene, ",\n", 2) == 0, text);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *path = fuzz_put("a.json", data, size);
    char *other = fuzz_put("b.json", NULL, 0);
    char *name = strndup((const char *)data, size);
    char *arguments[] = {name, NULL};
    struct reference_origin origin = {.width = 1,
                                      .height = 1,
                                      .spp = 1,
                                      .scene_path = name,
                                      .arguments = arguments};
    struct reference_info info, back;
    struct error err = {""};

    require(name != NULL, "memory");
    info = reference_info_read(path);
    if (info.is_known)
        check_numbers(&info);
    require(reference_info_write(&info, &origin, other, &err), err.text);
    check_written(other);
    back = reference_info_read(other);
    check_same(&info, &back);
    free(path);
    free(other);
    free(name);
    return 0;
}
