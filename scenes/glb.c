// SPDX-License-Identifier: MIT
#include "glb.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "image/stb.h"

/* Step of u and v between which a surface is flat, for its normals. */
#define STEP 1e-4

/* Steps of numbers in the file: finer than is seen, and coarser than the
 * differences between mathematical libraries. */
#define ROUNDING 4096.0

enum { FLOATS = 5126, SHORTS = 5123 };

static void stop(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, strerror(errno));
    exit(1);
}

static void *grown(void *memory, size_t size_bytes)
{
    void *found = realloc(memory, size_bytes);

    if (!found)
        stop("glb");
    return found;
}

/* ---- lists ---- */

static void append_text(struct glb_list *list, const char *text)
{
    size_t length = strlen(text);

    list->text = grown(list->text, list->size_bytes + length + 1);
    memcpy(list->text + list->size_bytes, text, length + 1);
    list->size_bytes += length;
}

static uint32_t add(struct glb_list *list, const char *format, va_list values)
    __attribute__((format(printf, 2, 0)));

static uint32_t add(struct glb_list *list, const char *format, va_list values)
{
    char text[4096];
    int length = vsnprintf(text, sizeof text, format, values);

    if (length < 0 || (size_t)length >= sizeof text) {
        fputs("glb: a value is too long\n", stderr);
        exit(1);
    }
    if (list->count > 0)
        append_text(list, ",\n");
    append_text(list, text);
    return list->count++;
}

uint32_t glb_add(struct glb_list *list, const char *format, ...)
{
    va_list values;
    uint32_t number;

    va_start(values, format);
    number = add(list, format, values);
    va_end(values);
    return number;
}

void glb_use(struct glb *g, const char *extension)
{
    char quoted[64];

    snprintf(quoted, sizeof quoted, "\"%s\"", extension);
    if (!g->extensions.text || !strstr(g->extensions.text, quoted))
        glb_add(&g->extensions, "%s", quoted);
}

/* ---- the buffer ---- */

static double rounded(double x)
{
    return floor(x * ROUNDING + .5) / ROUNDING + 0.0; /* never -0 */
}

/* Appends bytes as a view, at a place that 4 divides. */
static uint32_t add_view(struct glb *g, const void *bytes, size_t size_bytes)
{
    size_t at = (g->size_bytes + 3) / 4 * 4;

    g->bytes = grown(g->bytes, at + size_bytes);
    memset(g->bytes + g->size_bytes, 0, at - g->size_bytes);
    memcpy(g->bytes + at, bytes, size_bytes);
    g->size_bytes = at + size_bytes;
    return glb_add(&g->views,
                   "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", at,
                   size_bytes);
}

/* Writes the least and greatest numbers, which positions must have. */
static void write_bounds(char *text, size_t size_bytes, const float *numbers,
                         int count, int components)
{
    char lists[2][256] = {"", ""};

    for (int c = 0; c < components; c++) {
        float lo = numbers[c], hi = numbers[c];
        const float *ends[2] = {&lo, &hi};

        for (int i = 1; i < count; i++) {
            float x = numbers[i * components + c];

            lo = x < lo ? x : lo;
            hi = x > hi ? x : hi;
        }
        for (int k = 0; k < 2; k++) {
            size_t used = strlen(lists[k]);

            snprintf(lists[k] + used, sizeof lists[k] - used, "%s%.9g",
                     c > 0 ? "," : "", (double)*ends[k]);
        }
    }
    snprintf(text, size_bytes, ",\"min\":[%s],\"max\":[%s]", lists[0],
             lists[1]);
}

uint32_t glb_floats(struct glb *g, const double *numbers, int count,
                    int components, const char *type)
{
    size_t n = (size_t)count * (size_t)components;
    float *floats = grown(NULL, n * sizeof *floats);
    char bounds[600] = "";
    uint32_t view;

    for (size_t i = 0; i < n; i++)
        floats[i] = (float)rounded(numbers[i]);
    view = add_view(g, floats, n * sizeof *floats);
    if (components <= 4)
        write_bounds(bounds, sizeof bounds, floats, count, components);
    free(floats);
    return glb_add(&g->accessors,
                   "{\"bufferView\":%u,\"componentType\":%d,\"count\":%d,"
                   "\"type\":\"%s\"%s}",
                   view, FLOATS, count, type, bounds);
}

static uint32_t add_shorts(struct glb *g, const uint16_t *numbers, int count,
                           int components, const char *type)
{
    uint32_t view = add_view(g, numbers, 2 * (size_t)(count * components));

    return glb_add(&g->accessors,
                   "{\"bufferView\":%u,\"componentType\":%d,\"count\":%d,"
                   "\"type\":\"%s\"}",
                   view, SHORTS, count, type);
}

/* ---- images ---- */

struct output {
    uint8_t *bytes;
    size_t size_bytes;
};

static void append_bytes(void *context, void *data, int size_bytes)
{
    struct output *out = context;

    out->bytes = grown(out->bytes, out->size_bytes + (size_t)size_bytes);
    memcpy(out->bytes + out->size_bytes, data, (size_t)size_bytes);
    out->size_bytes += (size_t)size_bytes;
}

uint32_t glb_texture(struct glb *g, const uint8_t *rgb, int width, int height,
                     int is_pixels)
{
    struct output out = {NULL, 0};
    uint32_t image, sampler;

    if (!stbi_write_png_to_func(append_bytes, &out, width, height, 3, rgb,
                                width * 3))
        stop("glb");
    image =
        glb_add(&g->images, "{\"bufferView\":%u,\"mimeType\":\"image/png\"}",
                add_view(g, out.bytes, out.size_bytes));
    free(out.bytes);
    sampler = glb_add(&g->samplers, "{\"magFilter\":%d}",
                      is_pixels ? 9728 : 9729); /* nearest, linear */
    return glb_add(&g->textures, "{\"source\":%u,\"sampler\":%u}", image,
                   sampler);
}

/* ---- meshes ---- */

static struct point minus(struct point a, struct point b)
{
    return (struct point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct point cross(struct point a, struct point b)
{
    return (struct point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                          a.x * b.y - a.y * b.x};
}

static struct point unit(struct point a)
{
    double length = sqrt(a.x * a.x + a.y * a.y + a.z * a.z);

    return length > 0 ? (struct point){a.x / length, a.y / length, a.z / length}
                      : (struct point){0, 1, 0};
}

/* Returns the normal, at an end of v that of a place beside it, since all
 * points of an end may be one. */
static struct point normal_of(const struct glb_grid *grid, glb_function *place,
                              double u, double v)
{
    const void *c = grid->context;
    struct point du, dv;

    v = fmin(fmax(v, 2 * STEP), 1 - 2 * STEP);
    du = minus(place(c, u + STEP, v), place(c, u - STEP, v));
    dv = minus(place(c, u, v + STEP), place(c, u, v - STEP));
    return unit(cross(du, dv));
}

static void put(double *to, struct point p)
{
    to[0] = p.x;
    to[1] = p.y;
    to[2] = p.z;
}

static int is_same_place(const double *places, int a, int b)
{
    for (int i = 0; i < 3; i++)
        if (rounded(places[3 * a + i]) != rounded(places[3 * b + i]))
            return 0;
    return 1;
}

/* Adds the triangles of a grid, counter-clockwise, without those that the ends
 * of a closed shape make a line. */
static uint32_t add_indices(struct glb *g, const struct glb_grid *grid,
                            const double *places)
{
    int count = 0, stride = grid->columns + 1;
    uint16_t *indices = grown(NULL, 12 * (size_t)(grid->columns * grid->rows));
    uint32_t accessor;

    for (int i = 0; i < 2 * grid->rows * grid->columns; i++) {
        int a = i / 2 / grid->columns * stride + i / 2 % grid->columns;
        const int corners[2][3] = {{a, a + 1, a + 1 + stride},
                                   {a, a + 1 + stride, a + stride}};
        const int *c = corners[i % 2];

        if (is_same_place(places, c[0], c[1]) ||
            is_same_place(places, c[1], c[2]) ||
            is_same_place(places, c[2], c[0]))
            continue;
        for (int k = 0; k < 3; k++)
            indices[count++] = (uint16_t)c[k];
    }
    accessor = add_shorts(g, indices, count, 1, "SCALAR");
    free(indices);
    return accessor;
}

/* Appends the accessor of an attribute to the text. */
static void name_attribute(char *text, size_t size_bytes, const char *name,
                           uint32_t accessor)
{
    size_t used = strlen(text);

    snprintf(text + used, size_bytes - used, "%s\"%s\":%u", used > 0 ? "," : "",
             name, accessor);
}

/* Adds the joints of each vertex: the two nearest ones along v. */
static void add_joints(struct glb *g, const struct glb_grid *grid, int count,
                       char *text, size_t size_bytes)
{
    uint16_t *joints = grown(NULL, 8 * (size_t)count);
    double *weights = grown(NULL, 4 * sizeof *weights * (size_t)count);

    for (int i = 0; i < count; i++) {
        double v = (double)(i / (grid->columns + 1)) / grid->rows;
        double at = v * (grid->joint_count - 1);
        int first = (int)fmin(at, grid->joint_count - 2);

        for (int k = 0; k < 4; k++) {
            joints[4 * i + k] = (uint16_t)(k < 2 ? first + k : 0);
            weights[4 * i + k] = k == 0   ? 1 - (at - first)
                                 : k == 1 ? at - first
                                          : 0;
        }
    }
    name_attribute(text, size_bytes, "JOINTS_0",
                   add_shorts(g, joints, count, 4, "VEC4"));
    name_attribute(text, size_bytes, "WEIGHTS_0",
                   glb_floats(g, weights, count, 4, "VEC4"));
    free(joints);
    free(weights);
}

/* Adds places and normals of a function; as differences from those of `base`,
 * if that is not NULL. Returns the places, for free(). */
static double *add_places(struct glb *g, const struct glb_grid *grid,
                          glb_function *place, glb_function *base, char *text,
                          size_t size_bytes)
{
    int columns = grid->columns, count = (columns + 1) * (grid->rows + 1);
    double *places = grown(NULL, 3 * sizeof *places * (size_t)count);
    double *normals = grown(NULL, 3 * sizeof *normals * (size_t)count);

    for (int i = 0; i < count; i++) {
        double u = (double)(i % (columns + 1)) / columns;
        double v = (double)(i / (columns + 1)) / grid->rows;
        struct point p = place(grid->context, u, v);
        struct point n = normal_of(grid, place, u, v);

        if (base) {
            p = minus(p, base(grid->context, u, v));
            n = minus(n, normal_of(grid, base, u, v));
        }
        put(places + 3 * i, p);
        put(normals + 3 * i, n);
    }
    name_attribute(text, size_bytes, "POSITION",
                   glb_floats(g, places, count, 3, "VEC3"));
    name_attribute(text, size_bytes, "NORMAL",
                   glb_floats(g, normals, count, 3, "VEC3"));
    free(normals);
    return places;
}

static void add_uvs(struct glb *g, const struct glb_grid *grid, char *text,
                    size_t size_bytes)
{
    int columns = grid->columns, count = (columns + 1) * (grid->rows + 1);
    double *uvs = grown(NULL, 2 * sizeof *uvs * (size_t)count);

    for (int i = 0; i < count; i++) {
        uvs[2 * i] = grid->u_repeat * (i % (columns + 1)) / columns;
        uvs[2 * i + 1] = grid->v_repeat * (i / (columns + 1)) / grid->rows;
    }
    name_attribute(text, size_bytes, "TEXCOORD_0",
                   glb_floats(g, uvs, count, 2, "VEC2"));
    free(uvs);
}

char *glb_shape(struct glb *g, const struct glb_grid *grid)
{
    int count = (grid->columns + 1) * (grid->rows + 1);
    char attributes[512] = "", target[256] = "", targets[300] = "";
    char *text = grown(NULL, 1024);
    double *places;

    if (count > 65535)
        stop("glb: a grid is too large");
    places =
        add_places(g, grid, grid->place, NULL, attributes, sizeof attributes);
    if (grid->u_repeat > 0)
        add_uvs(g, grid, attributes, sizeof attributes);
    if (grid->joint_count > 0)
        add_joints(g, grid, count, attributes, sizeof attributes);
    if (grid->target) {
        free(add_places(g, grid, grid->target, grid->place, target,
                        sizeof target));
        snprintf(targets, sizeof targets, ",\"targets\":[{%s}]", target);
    }
    snprintf(text, 1024, "\"attributes\":{%s},\"indices\":%u%s", attributes,
             add_indices(g, grid, places), targets);
    free(places);
    return text;
}

char *glb_triangles(struct glb *g, const double *places, const double *normals,
                    int count, const uint16_t *corners, int corner_count)
{
    char *text = grown(NULL, 200);
    uint32_t place = glb_floats(g, places, count, 3, "VEC3");
    uint32_t normal = glb_floats(g, normals, count, 3, "VEC3");

    snprintf(text, 200,
             "\"attributes\":{\"POSITION\":%u,\"NORMAL\":%u},\"indices\":%u",
             place, normal, add_shorts(g, corners, corner_count, 1, "SCALAR"));
    return text;
}

uint32_t glb_mesh_of(struct glb *g, const char *shape, uint32_t material)
{
    return glb_add(&g->meshes, "{\"primitives\":[{%s,\"material\":%u}]}", shape,
                   material);
}

uint32_t glb_mesh(struct glb *g, const struct glb_grid *grid, uint32_t material)
{
    char *shape = glb_shape(g, grid);
    uint32_t mesh = glb_mesh_of(g, shape, material);

    free(shape);
    return mesh;
}

/* ---- animations ---- */

void glb_animation(struct glb *g, const char *name,
                   const struct glb_list *channels,
                   const struct glb_list *samplers)
{
    if (g->animations.count++ > 0)
        append_text(&g->animations, ",\n");
    append_text(&g->animations, "{\"name\":\"");
    append_text(&g->animations, name);
    append_text(&g->animations, "\",\"channels\":[");
    append_text(&g->animations, channels->text);
    append_text(&g->animations, "],\"samplers\":[");
    append_text(&g->animations, samplers->text);
    append_text(&g->animations, "]}");
}

/* ---- nodes ---- */

uint32_t glb_root(struct glb *g, const char *format, ...)
{
    char members[4000];
    va_list values;
    uint32_t node;

    va_start(values, format);
    vsnprintf(members, sizeof members, format, values);
    va_end(values);
    node = glb_add(&g->nodes, "{%s}", members);
    glb_add(&g->roots, "%u", node);
    return node;
}

/* Writes the matrix of what looks from `eye` to `at`. */
static void write_matrix(char text[400], struct point eye, struct point at)
{
    struct point back = unit(minus(eye, at));
    struct point right = unit(cross((struct point){0, 1, 0}, back));
    struct point up = cross(back, right);

    snprintf(text, 400,
             "\"matrix\":[%.5f,%.5f,%.5f,0,%.5f,%.5f,%.5f,0,%.5f,%.5f,%.5f,0,"
             "%.5f,%.5f,%.5f,1]",
             rounded(right.x), rounded(right.y), rounded(right.z),
             rounded(up.x), rounded(up.y), rounded(up.z), rounded(back.x),
             rounded(back.y), rounded(back.z), eye.x, eye.y, eye.z);
}

void glb_camera(struct glb *g, struct point eye, struct point at,
                double yfov_deg)
{
    char matrix[400];
    uint32_t camera = glb_add(&g->cameras,
                              "{\"type\":\"perspective\",\"perspective\":"
                              "{\"yfov\":%.5f,\"znear\":0.01}}",
                              yfov_deg * 3.14159265 / 180);

    write_matrix(matrix, eye, at);
    glb_root(g, "\"name\":\"camera\",\"camera\":%u,%s", camera, matrix);
}

void glb_light(struct glb *g, struct point eye, struct point at,
               const char *light)
{
    char matrix[400];
    uint32_t number = glb_add(&g->lights, "{%s}", light);

    glb_use(g, "KHR_lights_punctual");
    write_matrix(matrix, eye, at);
    glb_root(g,
             "\"name\":\"light\",\"extensions\":{\"KHR_lights_punctual\":"
             "{\"light\":%u}},%s",
             number, matrix);
}

/* ---- the file ---- */

static void put_list(struct glb_list *json, const char *name,
                     const struct glb_list *list)
{
    if (list->count == 0)
        return;
    append_text(json, ",\n\"");
    append_text(json, name);
    append_text(json, "\":[");
    append_text(json, list->text);
    append_text(json, "]");
}

static void make_json(struct glb_list *json, const struct glb *g)
{
    char text[200];

    append_text(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":"
                      "\"glim, scenes/generate.c\"},\n\"scene\":0");
    append_text(json, ",\n\"scenes\":[{\"nodes\":[");
    append_text(json, g->roots.text);
    append_text(json, "]}]");
    put_list(json, "extensionsUsed", &g->extensions);
    put_list(json, "nodes", &g->nodes);
    put_list(json, "cameras", &g->cameras);
    put_list(json, "meshes", &g->meshes);
    put_list(json, "skins", &g->skins);
    put_list(json, "animations", &g->animations);
    put_list(json, "materials", &g->materials);
    put_list(json, "textures", &g->textures);
    put_list(json, "samplers", &g->samplers);
    put_list(json, "images", &g->images);
    put_list(json, "accessors", &g->accessors);
    put_list(json, "bufferViews", &g->views);
    if (g->lights.count > 0) {
        append_text(json, ",\n\"extensions\":{\"KHR_lights_punctual\":"
                          "{\"lights\":[");
        append_text(json, g->lights.text);
        append_text(json, "]}}");
    }
    snprintf(text, sizeof text, ",\n\"buffers\":[{\"byteLength\":%zu}]}",
             g->size_bytes);
    append_text(json, text);
    while (json->size_bytes % 4 != 0)
        append_text(json, " ");
}

static void put32(FILE *file, size_t value)
{
    for (int i = 0; i < 4; i++)
        fputc((int)(value >> 8 * i & 255), file);
}

void glb_write(const struct glb *g, const char *folder, const char *name)
{
    size_t padded = (g->size_bytes + 3) / 4 * 4;
    struct glb_list json = {NULL, 0, 0};
    char path[4096];
    FILE *file;

    make_json(&json, g);
    snprintf(path, sizeof path, "%s/%s.glb", folder, name);
    file = fopen(path, "wb");
    if (!file)
        stop(path);
    fputs("glTF", file);
    put32(file, 2);
    put32(file, 12 + 8 + json.size_bytes + 8 + padded);
    put32(file, json.size_bytes);
    fputs("JSON", file);
    fputs(json.text, file);
    put32(file, padded);
    fwrite("BIN", 1, 4, file);
    fwrite(g->bytes, 1, g->size_bytes, file);
    for (size_t i = g->size_bytes; i < padded; i++)
        fputc(0, file);
    if (ferror(file) || fclose(file) != 0)
        stop(path);
    free(json.text);
}

void glb_free(struct glb *g)
{
    struct glb_list *const lists[] = {
        &g->extensions, &g->nodes,  &g->roots,    &g->meshes,    &g->materials,
        &g->textures,   &g->images, &g->samplers, &g->views,     &g->accessors,
        &g->cameras,    &g->lights, &g->skins,    &g->animations};

    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        free(lists[i]->text);
    free(g->bytes);
}
