// SPDX-License-Identifier: MIT
/*
 * gltf_value.h - typed access to the JSON of a glTF document
 *
 * A value knows its parents, so that a failure can name its place:
 * "model.gltf: /meshes/3/primitives/0/indices: found 99, expected one of 12
 * accessors". The parents are on the callers' stacks.
 *
 * Ownership: values and strings are the document's
 * Threads:   any, once the document is open
 * Errors:    a value of another kind or out of its range
 */
#ifndef GLIM_GLTF_VALUE_H
#define GLIM_GLTF_VALUE_H

#include <jansson.h>
#include <stdint.h>

#include "read/gltf/gltf_document.h"

/* Index of values that are no items of an array. */
#define GLTF_NO_ITEM SIZE_MAX

struct gltf_value {
    const struct gltf_document *document;
    const struct gltf_value *parent; /* NULL for members of the root */
    const char *key;
    size_t index; /* of an item of the array `key` */
    bool is_extension;
    json_t *json; /* NULL: the document does not have it */
};

/* Adds the document's name and the value's place to the message. */
bool gltf_fail(const struct gltf_value *value, struct error *err,
               const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Takes `count` items from the memory that the document may take, before they
 * are allocated. `what` is the word for them in messages. */
bool gltf_take(const struct gltf_value *value, uint64_t count,
               uint64_t item_bytes, const char *what, struct error *err);

/* Returns the value's place, such as "/meshes/3", for free(); NULL when memory
 * is out. */
char *gltf_place(const struct gltf_value *value);

/* Returns the root. */
struct gltf_value gltf_root(const struct gltf_document *document);

/* Read a member of an object, or an item of an array as an object. An absent
 * member has no json. */
bool gltf_object(const struct gltf_value *object, const char *key,
                 struct gltf_value *to, struct error *err);
bool gltf_array(const struct gltf_value *object, const char *key,
                struct gltf_value *to, struct error *err);
bool gltf_item_object(const struct gltf_value *array, size_t index,
                      struct gltf_value *to, struct error *err);

/* Reads the extension of this name, an object. */
bool gltf_extension(const struct gltf_value *object, const char *name,
                    struct gltf_value *to, struct error *err);

/* Reads item `index` of an array of the root, such as "meshes". */
bool gltf_entry(const struct gltf_document *document, const char *collection,
                size_t index, struct gltf_value *to, struct error *err);

/* Returns the number of items of an array of the root; 0 if it is absent. */
size_t gltf_entry_count(const struct gltf_document *document,
                        const char *collection);

/* Returns the name of the program that wrote the document, or "". */
const char *gltf_generator(const struct gltf_document *document);

/* Returns the array of KHR_lights_punctual; NULL if it is absent. */
const json_t *gltf_lights(const struct gltf_document *document);

/* Finds an entry by its number, from 1, or its name. `what` is the word for it
 * in messages. */
bool gltf_find(const struct gltf_document *document, const char *collection,
               const char *what, const char *wanted, uint32_t *index,
               struct error *err);

/* Returns the number of items; 0 if the array is absent. */
size_t gltf_count(const struct gltf_value *array);

/* These leave *to unchanged if the member is absent. */
bool gltf_number(const struct gltf_value *object, const char *key, double least,
                 double most, double *to, struct error *err);
bool gltf_integer(const struct gltf_value *object, const char *key,
                  uint64_t most, uint64_t *to, struct error *err);
bool gltf_numbers(const struct gltf_value *object, const char *key,
                  size_t count, double *to, struct error *err);
bool gltf_flag(const struct gltf_value *object, const char *key, bool *to,
               struct error *err);
bool gltf_string(const struct gltf_value *object, const char *key,
                 const char **to, struct error *err);

/* Reads the number of an entry of `collection`, as gltf_entry() takes it;
 * NO_INDEX if it is absent. */
bool gltf_index(const struct gltf_value *object, const char *key,
                const char *collection, uint32_t *to, struct error *err);
bool gltf_item_index(const struct gltf_value *array, size_t index,
                     const char *collection, uint32_t *to, struct error *err);

/* Reads an item that is a number. */
bool gltf_item_number(const struct gltf_value *array, size_t index, double *to,
                      struct error *err);

#endif
