// SPDX-License-Identifier: MIT
#include "read/gltf/gltf_value.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "kernels/types.h"

char *gltf_place(const struct gltf_value *value)
{
    char *text = strdup("");

    for (const struct gltf_value *v = value; text != NULL && v != NULL;
         v = v->parent) {
        char *last = text;

        if (v->key == NULL) /* the root */
            break;
        if (v->index == GLTF_NO_ITEM)
            text = format_text("/%s%s%s", v->is_extension ? "extensions/" : "",
                               v->key, last);
        else
            text = format_text("/%s/%zu%s", v->key, v->index, last);
        free(last);
    }
    return text;
}

bool gltf_fail(const struct gltf_value *value, struct error *err,
               const char *format, ...)
{
    char *place = gltf_place(value), *text;
    va_list values;

    va_start(values, format);
    text = format_list(format, values);
    va_end(values);
    fail(err, "%s: %s%s%s", value->document->path, place != NULL ? place : "",
         place != NULL && *place != '\0' ? ": " : "",
         text != NULL ? text : "out of memory for the message");
    free(place);
    free(text);
    return false;
}

bool gltf_take(const struct gltf_value *value, uint64_t count,
               uint64_t item_bytes, const char *what, struct error *err)
{
    struct memory_budget *memory = value->document->memory;

    return memory == NULL || memory_budget_take(memory, count, item_bytes) ||
           gltf_fail(value, err,
                     "found %" PRIu64 " %s, expected a scene that takes at "
                     "most %.1f GiB %s",
                     count, what, (double)memory->size_bytes / (1 << 30),
                     memory->place);
}

/* Description of a value for messages. */
struct found {
    char text[64];
};

static struct found describe(const json_t *json)
{
    struct found f = {"null"};

    switch (json_typeof(json)) {
    case JSON_OBJECT: return (struct found){"an object"};
    case JSON_ARRAY:
        snprintf(f.text, sizeof f.text, "an array of %zu",
                 json_array_size(json));
        break;
    case JSON_STRING:
        snprintf(f.text, sizeof f.text, "\"%.40s\"", json_string_value(json));
        break;
    case JSON_INTEGER:
        snprintf(f.text, sizeof f.text, "%" JSON_INTEGER_FORMAT,
                 json_integer_value(json));
        break;
    case JSON_REAL:
        snprintf(f.text, sizeof f.text, "%g", json_real_value(json));
        break;
    case JSON_TRUE: return (struct found){"true"};
    case JSON_FALSE: return (struct found){"false"};
    case JSON_NULL: break;
    }
    return f;
}

static bool expected(const struct gltf_value *v, const char *what,
                     struct error *err)
{
    return gltf_fail(v, err, "found %s, expected %s", describe(v->json).text,
                     what);
}

struct gltf_value gltf_root(const struct gltf_document *document)
{
    return (struct gltf_value){.document = document,
                               .index = GLTF_NO_ITEM,
                               .json = document->root};
}

static struct gltf_value member(const struct gltf_value *object,
                                const char *key)
{
    return (struct gltf_value){
        .document = object->document,
        .parent = object,
        .key = key,
        .index = GLTF_NO_ITEM,
        .json = json_object_get(object->json, key),
    };
}

static struct gltf_value item(const struct gltf_value *array, size_t index)
{
    struct gltf_value v = *array;

    v.index = index;
    v.json = json_array_get(array->json, index);
    return v;
}

bool gltf_object(const struct gltf_value *object, const char *key,
                 struct gltf_value *to, struct error *err)
{
    *to = member(object, key);
    return to->json == NULL || json_is_object(to->json) ||
           expected(to, "an object", err);
}

bool gltf_array(const struct gltf_value *object, const char *key,
                struct gltf_value *to, struct error *err)
{
    *to = member(object, key);
    return to->json == NULL || json_is_array(to->json) ||
           expected(to, "an array", err);
}

bool gltf_item_object(const struct gltf_value *array, size_t index,
                      struct gltf_value *to, struct error *err)
{
    *to = item(array, index);
    return json_is_object(to->json) || expected(to, "an object", err);
}

bool gltf_extension(const struct gltf_value *object, const char *name,
                    struct gltf_value *to, struct error *err)
{
    struct gltf_value all = member(object, "extensions");

    *to = member(object, name);
    to->is_extension = true;
    to->json = json_object_get(all.json, name);
    if (all.json != NULL && !json_is_object(all.json))
        return expected(&all, "an object", err);
    return to->json == NULL || json_is_object(to->json) ||
           expected(to, "an object", err);
}

/* Returns an array of the root or of one of its extensions, whose kind
 * gltf_document_open() has checked. */
static struct gltf_value collection_of(const struct gltf_document *document,
                                       const char *collection)
{
    static const char *const extended[][2] = {
        {"lights", "KHR_lights_punctual"},
        {"variants", "KHR_materials_variants"},
    };
    struct gltf_value root = gltf_root(document);
    struct gltf_value v = member(&root, collection);

    for (size_t i = 0; i < sizeof extended / sizeof extended[0]; i++)
        if (strcmp(collection, extended[i][0]) == 0)
            v.json =
                json_object_get(json_object_get(json_object_get(root.json,
                                                                "extensions"),
                                                extended[i][1]),
                                collection);
    v.parent = NULL;
    return v;
}

size_t gltf_entry_count(const struct gltf_document *document,
                        const char *collection)
{
    struct gltf_value v = collection_of(document, collection);

    return gltf_count(&v);
}

bool gltf_entry(const struct gltf_document *document, const char *collection,
                size_t index, struct gltf_value *to, struct error *err)
{
    struct gltf_value v = collection_of(document, collection);

    return gltf_item_object(&v, index, to, err);
}

const char *gltf_generator(const struct gltf_document *document)
{
    const char *name = json_string_value(
        json_object_get(json_object_get(document->root, "asset"), "generator"));

    return name != NULL ? name : "";
}

const json_t *gltf_lights(const struct gltf_document *document)
{
    return collection_of(document, "lights").json;
}

bool gltf_find(const struct gltf_document *document, const char *collection,
               const char *what, const char *wanted, uint32_t *index,
               struct error *err)
{
    struct gltf_value list = collection_of(document, collection);
    size_t count = gltf_count(&list);
    const char *p = wanted;
    uint64_t number;

    if (digits_parse(&p, 10, UINT32_MAX, &number) && *p == '\0' &&
        number >= 1 && number <= count) {
        *index = (uint32_t)number - 1;
        return true;
    }
    for (*index = 0; *index < count; ++*index) {
        const char *name = json_string_value(
            json_object_get(json_array_get(list.json, *index), "name"));

        if (name != NULL && strcmp(name, wanted) == 0)
            return true;
    }
    if (count == 0)
        return fail(err, "%s: found no %s at all, expected '%.80s'",
                    document->path, what, wanted);
    return fail(err, "%s: found no %s '%.80s', expected a name or 1 to %zu",
                document->path, what, wanted, count);
}

size_t gltf_count(const struct gltf_value *array)
{
    return json_array_size(array->json);
}

bool gltf_number(const struct gltf_value *object, const char *key, double least,
                 double most, double *to, struct error *err)
{
    struct gltf_value v = member(object, key);
    double number;
    char range[80];

    if (v.json == NULL)
        return true;
    number = json_number_value(v.json);
    if (!json_is_number(v.json))
        return expected(&v, "a number", err);
    if (number < least || number > most) {
        snprintf(range, sizeof range, "a number from %g to %g", least, most);
        return expected(&v, range, err);
    }
    *to = number;
    return true;
}

/* Takes integers and, as Khronos' validator does, numbers such as 1.0. */
static bool to_integer(const struct gltf_value *v, uint64_t most, uint64_t *to)
{
    double real = json_number_value(v->json);

    if (json_is_integer(v->json)) {
        *to = (uint64_t)json_integer_value(v->json);
        return json_integer_value(v->json) >= 0 && *to <= most;
    }
    if (!json_is_real(v->json) || !(real >= 0 && real < 0x1p53) ||
        real != floor(real))
        return false;
    *to = (uint64_t)real;
    return *to <= most;
}

bool gltf_integer(const struct gltf_value *object, const char *key,
                  uint64_t most, uint64_t *to, struct error *err)
{
    struct gltf_value v = member(object, key);
    uint64_t number;
    char range[80];

    if (v.json == NULL)
        return true;
    if (to_integer(&v, most, &number)) {
        *to = number;
        return true;
    }
    if (most == INT64_MAX)
        return expected(&v, "an integer from 0", err);
    snprintf(range, sizeof range, "an integer from 0 to %" PRIu64, most);
    return expected(&v, range, err);
}

bool gltf_numbers(const struct gltf_value *object, const char *key,
                  size_t count, double *to, struct error *err)
{
    struct gltf_value v = member(object, key);
    char what[40];

    if (v.json == NULL)
        return true;
    snprintf(what, sizeof what, "an array of %zu numbers", count);
    if (!json_is_array(v.json) || gltf_count(&v) != count)
        return expected(&v, what, err);
    for (size_t i = 0; i < count; i++)
        if (!gltf_item_number(&v, i, &to[i], err))
            return false;
    return true;
}

bool gltf_item_number(const struct gltf_value *array, size_t index, double *to,
                      struct error *err)
{
    struct gltf_value v = item(array, index);

    *to = json_number_value(v.json);
    return json_is_number(v.json) || expected(&v, "a number", err);
}

bool gltf_flag(const struct gltf_value *object, const char *key, bool *to,
               struct error *err)
{
    struct gltf_value v = member(object, key);

    if (v.json == NULL)
        return true;
    *to = json_is_true(v.json);
    return json_is_boolean(v.json) || expected(&v, "true or false", err);
}

bool gltf_string(const struct gltf_value *object, const char *key,
                 const char **to, struct error *err)
{
    struct gltf_value v = member(object, key);

    if (v.json == NULL)
        return true;
    *to = json_string_value(v.json);
    return *to != NULL || expected(&v, "a string", err);
}

static bool to_index(const struct gltf_value *v, const char *collection,
                     uint32_t *to, struct error *err)
{
    size_t count = gltf_entry_count(v->document, collection);
    uint64_t index = 0;
    char what[80];

    if (count > 0 && count < NO_INDEX && to_integer(v, count - 1, &index)) {
        *to = (uint32_t)index;
        return true;
    }
    snprintf(what, sizeof what, "one of %zu %s", count, collection);
    return expected(v, what, err);
}

bool gltf_index(const struct gltf_value *object, const char *key,
                const char *collection, uint32_t *to, struct error *err)
{
    struct gltf_value v = member(object, key);

    *to = NO_INDEX;
    return v.json == NULL || to_index(&v, collection, to, err);
}

bool gltf_item_index(const struct gltf_value *array, size_t index,
                     const char *collection, uint32_t *to, struct error *err)
{
    struct gltf_value v = item(array, index);

    return to_index(&v, collection, to, err);
}
