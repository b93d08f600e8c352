// SPDX-License-Identifier: MIT
/* test_gltf_material.c - materials of glTF files against the values that an
 * independent reader found, and textures against closed forms */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "read/gltf/gltf_material.h"
#include "read/mtl.h"
#include "read/mtl_save.h"
#include "tests/unit/files.h"
#include "tests/unit/shared.h"

/* A document and the scene with its materials. */
struct loaded {
    char *bytes;
    struct gltf_document document;
    struct scene scene;
    struct warnings report;
    struct error err;
    bool ok;
};

static void load(struct loaded *l, const char *path)
{
    size_t size_bytes;

    memset(l, 0, sizeof *l);
    l->ok = file_read(path, &l->bytes, &size_bytes, &l->err) &&
            mtl_add_default(&l->scene, &l->err) &&
            gltf_document_open(&l->document, l->bytes, size_bytes, path,
                               &l->report, &l->err) &&
            gltf_materials_read(&l->document, &l->scene, &l->report, &l->err);
}

static void unload(struct loaded *l)
{
    gltf_document_close(&l->document);
    scene_free(&l->scene);
    warnings_free(&l->report);
    free(l->bytes);
}

/* ---- values of the shared files ---- */

/* Returns a number of an object, or `missing`. */
static double number(const json_t *object, const char *key, double missing)
{
    const json_t *v = json_object_get(object, key);

    return v != NULL ? json_number_value(v) : missing;
}

static void expect_color(struct vec3 c, const json_t *object, const char *key,
                         double missing, double factor)
{
    const json_t *v = json_object_get(object, key);
    const float is[3] = {c.x, c.y, c.z};

    for (size_t i = 0; i < 3; i++) {
        double want =
            v != NULL ? json_number_value(json_array_get(v, i)) : missing;

        check_close((double)is[i], fmax(want, 0) * factor,
                    1e-6 * (1 + want * factor));
    }
}

static bool has_texture(const json_t *want, const char *name)
{
    const json_t *list = json_object_get(want, "textures");

    for (size_t i = 0; i < json_array_size(list); i++)
        if (strcmp(json_string_value(json_array_get(list, i)), name) == 0)
            return true;
    return false;
}

static void expect_coverage(const struct material *m, const json_t *want)
{
    const char *mode = json_string_value(json_object_get(want, "alpha_mode"));
    double alpha = json_number_value(
        json_array_get(json_object_get(want, "base_color"), 3));

    check_close((double)m->opacity, strcmp(mode, "OPAQUE") == 0 ? 1 : alpha,
                1e-6);
    check_close((double)m->cutoff,
                strcmp(mode, "MASK") == 0 ? number(want, "alpha_cutoff", 0.5)
                                          : 0,
                1e-6);
}

/* F0 of KHR_materials_ior and KHR_materials_specular. */
static void expect_specular(const struct material *m, const json_t *want)
{
    const json_t *s = json_object_get(want, "specular");
    double ior = number(want, "ior", 1.5);
    double f0 = pow((ior - 1) / (ior + 1), 2);

    if (m->kind == MATERIAL_METAL)
        return;
    expect_color(m->specular, s, "specularColorFactor", 1,
                 f0 * number(s, "specularFactor", 1));
}

static void expect_layers(const struct material *m, const json_t *want)
{
    const json_t *coat = json_object_get(want, "clearcoat");
    const json_t *sheen = json_object_get(want, "sheen");
    const json_t *film = json_object_get(want, "iridescence");
    const json_t *volume = json_object_get(want, "volume");
    double weight = number(want, "transmission", 0);
    double distance = number(volume, "attenuationDistance", 0);
    double rough = number(coat, "clearcoatRoughnessFactor", 0);

    check_close((double)m->transmission, weight, 1e-6);
    if (weight > 0) {
        assert_int_equal(m->is_thin,
                         !(number(volume, "thicknessFactor", 0) > 0));
        check_close((double)m->ior, number(want, "ior", 1.5), 1e-6);
        check_close((double)m->dispersion,
                    m->is_thin != 0
                        ? 0
                        : (number(want, "ior", 1.5) - 1) / 20 *
                              number(json_object_get(want, "dispersion"),
                                     "dispersion", 0),
                    1e-6);
    }
    for (size_t i = 0; i < 3 && weight > 0 && distance > 0 && m->is_thin == 0;
         i++) {
        const float is[3] = {m->medium.extinction.x, m->medium.extinction.y,
                             m->medium.extinction.z};
        const json_t *c = json_object_get(volume, "attenuationColor");

        check_close((double)is[i],
                    -log(json_number_value(json_array_get(c, i))) / distance,
                    1e-6);
    }
    check_close((double)m->coat, number(coat, "clearcoatFactor", 0), 1e-6);
    if (m->coat > 0)
        check_close((double)m->coat_alpha, rough * rough, 1e-6);
    expect_color(m->sheen, sheen, "sheenColorFactor", 0, 1);
    check_close((double)m->film, number(film, "iridescenceFactor", 0), 1e-6);
    if (m->film > 0) {
        check_close((double)m->film_ior, number(film, "iridescenceIor", 1.3),
                    1e-6);
        check_close((double)m->film_thickness,
                    number(film, "iridescenceThicknessMaximum", 400), 1e-3);
    }
}

/* Widths of the stretched highlight: a + (1 - a) s^2 and a, whose ratio is at
 * most 10 here. */
static void expect_roughness(const struct material *m, const json_t *want)
{
    double r = number(want, "roughness", 1), a = r * r;
    double s =
        number(json_object_get(want, "anisotropy"), "anisotropyStrength", 0);
    double stretch = 1 / sqrt(1 - 0.9 * (double)m->anisotropy);

    if (s > 0) {
        check_close((double)m->alpha * stretch, a + (1 - a) * s * s, 1e-5);
        check_close((double)m->alpha / stretch,
                    fmax(a, (a + (1 - a) * s * s) / 10), 1e-5);
    } else {
        check_close((double)m->alpha, a, 1e-6);
    }
}

static void expect_material(const struct material *m, const json_t *want)
{
    bool is_unlit = json_object_get(want, "unlit") != NULL;

    expect_coverage(m, want);
    if (is_unlit) {
        expect_color(m->emission, want, "base_color", 0, 1);
        return;
    }
    expect_color(m->color, want, "base_color", 1, 1);
    if (!has_texture(want, "emissiveTexture"))
        expect_color(m->emission, want, "emission", 0, 1);
    check_close((double)m->metalness, number(want, "metallic", 1), 1e-6);
    expect_roughness(m, want);
    expect_specular(m, want);
    expect_layers(m, want);
}

static void expect_file(const char *file, const json_t *materials)
{
    char *path = format_text("%s/suites/%s", shared_folder(), file);
    struct loaded l;
    size_t count;

    load(&l, path);
    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    /* behind those of the file is the default, if a primitive names none */
    count = 1 + json_array_size(materials);
    if (l.scene.material_count > count)
        assert_string_equal(l.scene.material_names[count++], "default");
    assert_int_equal(l.scene.material_count, count);
    for (size_t i = 0; i < json_array_size(materials); i++) {
        const json_t *want = json_array_get(materials, i);
        const char *name = json_string_value(json_object_get(want, "name"));

        if (json_object_get(want, "specular_glossiness") != NULL)
            continue;
        print_message("%s: %s\n", file, name);
        expect_material(&l.scene.materials[i + 1], want);
    }
    unload(&l);
    free(path);
}

/* Replaces a word by as many blanks behind a 0. */
static void replace_word(char *text, const char *word)
{
    size_t length = strlen(word);

    for (char *p = text; (p = strstr(p, word)) != NULL; p += length)
        memset(memset(p, ' ', length), '0', 1);
}

/* Returns the expectations of all files. Some readers found NaN, which is no
 * JSON. */
static json_t *read_expectations(void)
{
    char *path = shared_path("suites/gltf/expected.json"), *text, *copy;
    json_error_t why;
    struct error err;
    json_t *all;
    size_t size_bytes;

    check_or_say(file_read(path, &text, &size_bytes, &err), err.text);
    copy = strndup(text, size_bytes);
    replace_word(copy, "NaN");
    replace_word(copy, "Infinity");
    all = json_loads(copy, 0, &why);
    if (all == NULL)
        print_error("%s:%d: %s\n", path, why.line, why.text);
    assert_non_null(all);
    free(copy);
    free(text);
    free(path);
    return all;
}

static void values_are_those_of_an_independent_reader(void **state)
{
    json_t *all = read_expectations();
    const char *file;
    json_t *entry;
    int count = 0;

    (void)state;
    json_object_foreach (all, file, entry) {
        const char *expected =
            json_string_value(json_object_get(entry, "expected"));
        const json_t *spec =
            json_object_get(json_object_get(entry, "readers"), "spec");
        const json_t *materials = json_object_get(spec, "materials");

        if (strcmp(expected, "loads") != 0 || json_array_size(materials) == 0)
            continue;
        if (json_object_get(entry, "optional") != NULL)
            continue;
        expect_file(file, materials);
        count++;
    }
    assert_true(count > 50);
    json_decref(all);
}

/* ---- textures ---- */

#define PIXEL                                                                  \
    "data:image/png;base64,"                                                   \
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGA" \
    "WjR9awAAAABJRU5ErkJggg=="

static void load_text(struct loaded *l, const char *materials)
{
    char *text = format_text(
        "{\"asset\":{\"version\":\"2.0\"},\"images\":[{\"uri\":\"" PIXEL
        "\"}],\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648,"
        "\"magFilter\":9728}],\"textures\":[{\"source\":0},{\"source\":0,"
        "\"sampler\":0}],\"materials\":[%s]}",
        materials);

    put_bytes("a.gltf", text, strlen(text));
    free(text);
    load(l, "a.gltf");
}

static const struct texture *texture_of(const struct loaded *l, uint32_t i)
{
    assert_true(i < l->scene.texture_count);
    return &l->scene.textures[i];
}

/* The extension's matrix maps (u, 1 - v) to the place in the image, whose v is
 * 0 at the top. */
static void transforms_are_those_of_the_extension(void **state)
{
    const double c = cos(0.3), s = sin(0.3);
    const struct texture *t;
    struct loaded l;

    (void)state;
    load_text(&l, "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":"
                  "0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":"
                  "[0.1,0.2],\"rotation\":0.3,\"scale\":[2,3],\"texCoord\":1}}"
                  "}}}");
    assert_true(l.ok);
    t = texture_of(&l, l.scene.materials[1].color_texture);
    assert_int_equal(t->flags,
                     TEXTURE_ROTATED | TEXTURE_SECOND_UVS | TEXTURE_OPAQUE);
    for (int i = 0; i < 9; i++) {
        double u = i % 3 / 2., v = i / 3 / 2., down = 1 - v;
        double x = c * 2 * u + s * 3 * down + 0.1;
        double y = -s * 2 * u + c * 3 * down + 0.2;
        double a = u * (double)t->scale.x, b = v * (double)t->scale.y;

        check_close(a * (double)t->rotation.x - b * (double)t->rotation.y +
                        (double)t->offset.x,
                    x, 1e-6);
        check_close(a * (double)t->rotation.y + b * (double)t->rotation.x +
                        (double)t->offset.y,
                    1 - y, 1e-6);
    }
    unload(&l);
}

/* Maps of one image have its path, with the channels that glTF names. */
static void images_are_listed_once(void **state)
{
    struct loaded l;
    const struct material *m;

    (void)state;
    load_text(
        &l,
        "{\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{"
        "\"baseColorTexture\":{\"index\":1},\"metallicRoughnessTexture\":{"
        "\"index\":0}},\"normalTexture\":{\"index\":0,\"scale\":0.5},"
        "\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1,"
        "\"clearcoatTexture\":{\"index\":0},\"clearcoatNormalTexture\":{"
        "\"index\":1,\"scale\":0.25}}}}");
    assert_true(l.ok);
    m = &l.scene.materials[1];
    assert_int_equal(l.scene.image_count, 1);
    assert_string_equal(l.scene.images[0].name, "a.gltf#image0");
    assert_int_equal(texture_of(&l, m->color_texture)->flags,
                     TEXTURE_CLAMP_U | TEXTURE_MIRROR_V | TEXTURE_NEAREST);
    assert_int_equal(texture_of(&l, m->metal_texture)->channel, CHANNEL_BLUE);
    assert_int_equal(texture_of(&l, m->alpha_texture)->channel, CHANNEL_GREEN);
    assert_int_equal(texture_of(&l, m->coat_texture)->channel, CHANNEL_RED);
    assert_int_not_equal(m->coat_normal_texture, m->normal_texture);
    assert_int_not_equal(m->coat_normal_texture, NO_INDEX);
    check_close((double)m->coat_normal_strength, 0.25, 0);
    check_close((double)m->normal_strength, 0.5, 0);
    check_close((double)m->normal_depth, 1, 0);
    for (uint32_t i = 0; i < l.scene.texture_count; i++)
        assert_string_equal(l.scene.texture_paths[i], "a.gltf#image0");
    unload(&l);
}

/* Closed forms of the specification, without shared files. */
static void factors_become_values(void **state)
{
    const struct material *m;
    struct loaded l;

    (void)state;
    load_text(&l,
              "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,"
              "0.4],\"metallicFactor\":0},\"emissiveFactor\":[0.5,0,0],"
              "\"extensions\":{\"KHR_materials_emissive_strength\":{"
              "\"emissiveStrength\":6},\"KHR_materials_ior\":{\"ior\":2},"
              "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5}}},"
              "{\"extensions\":{\"KHR_materials_unlit\":{}},\"alphaMode\":"
              "\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,"
              "0.2,0.3,0.4],\"baseColorTexture\":{\"index\":0}}},"
              "{\"alphaMode\":\"MASK\",\"alphaCutoff\":0},"
              "{\"extensions\":{\"KHR_materials_transmission\":{"
              "\"transmissionFactor\":1},\"KHR_materials_volume\":{"
              "\"thicknessFactor\":1},\"KHR_materials_dispersion\":{"
              "\"dispersion\":0.4}}}");
    assert_true(l.ok);
    m = &l.scene.materials[1];
    check_close((double)m->color.z, 0.3, 1e-6);
    check_close((double)m->opacity, 1, 0);
    check_close((double)m->emission.x, 3, 1e-6);
    check_close((double)m->specular.x, 1. / 9, 1e-6);
    check_close((double)m->transmission, 0.5, 1e-6);
    assert_int_equal(m->is_thin, 1);
    m = &l.scene.materials[2];
    check_close((double)m->emission.y, 0.2, 1e-6);
    check_close((double)m->color.y, 0, 0);
    check_close((double)m->opacity, 0.4, 1e-6);
    assert_int_equal(texture_of(&l, m->opacity_texture)->channel,
                     CHANNEL_ALPHA);
    assert_int_equal(texture_of(&l, m->emission_texture)->is_data, 0);
    m = &l.scene.materials[3];
    assert_int_equal(m->kind, MATERIAL_METAL);
    check_close((double)m->cutoff, 0, 0);
    m = &l.scene.materials[4];
    check_close((double)m->dispersion, 0.5 / 50, 1e-8);
    unload(&l);
}

/* The weight is in the alpha of its texture. */
static void leaves_have_two_textures(void **state)
{
    const struct material *m;
    struct loaded l;

    (void)state;
    load_text(&l, "{\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
                  "\"extensions\":{\"KHR_materials_diffuse_transmission\":{"
                  "\"diffuseTransmissionFactor\":0.25,"
                  "\"diffuseTransmissionTexture\":{\"index\":0},"
                  "\"diffuseTransmissionColorFactor\":[0.9,0.6,0.3],"
                  "\"diffuseTransmissionColorTexture\":{\"index\":0}}}},"
                  "{\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
                  "\"extensions\":{\"KHR_materials_diffuse_transmission\":{"
                  "\"diffuseTransmissionColorTexture\":{\"index\":0}}}},"
                  "{\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
                  "\"extensions\":{\"KHR_materials_diffuse_transmission\":{"
                  "\"diffuseTransmissionFactor\":1}}}");
    assert_true(l.ok);
    assert_int_equal(l.report.entry_count, 0);
    m = &l.scene.materials[1];
    assert_int_equal(m->kind, MATERIAL_PLASTIC);
    check_close((double)m->translucency, 0.25, 0);
    check_close((double)m->back_color.y, 0.6, 1e-6);
    assert_int_equal(texture_of(&l, m->translucency_texture)->channel,
                     CHANNEL_ALPHA);
    assert_int_equal(texture_of(&l, m->translucency_texture)->is_data, 1);
    assert_int_equal(texture_of(&l, m->back_texture)->is_data, 0);
    check_close((double)l.scene.materials[2].translucency, 0, 0);
    check_close((double)l.scene.materials[3].translucency, 1, 0);
    check_close((double)l.scene.materials[3].back_color.z, 1, 0);
    unload(&l);
}

/* Share of the extinction that is scattered, as both drafts define it. */
static double single_scattering(double color, double cosine)
{
    double s = 4.09712 + 4.20863 * color -
               sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);

    return (1 - s * s) / (1 - cosine * s * s);
}

/* A body whose attenuation is 0.5 0.25 1 after a distance of 2. */
#define BODY(thickness, drafts)                                    \
    "{\"extensions\":{\"KHR_materials_transmission\":{"            \
    "\"transmissionFactor\":1},\"KHR_materials_volume\":{"         \
    "\"thicknessFactor\":" thickness ",\"attenuationDistance\":2," \
    "\"attenuationColor\":[0.5,0.25,1]}" drafts "}}"
#define NEWER(members) ",\"KHR_materials_scatter\":{" members "}"
#define OLDER(members) ",\"KHR_materials_volume_scatter\":{" members "}"

/* Media of the drafts KHR_materials_volume_scatter and KHR_materials_scatter:
 * the attenuation is the extinction, and where it is white there is nothing. */
static void drafts_scatter_what_is_attenuated(void **state)
{
    static const struct {
        const char *material;
        double color[3], cosine;
    } cases[] = {
        {BODY("1", ""), {0, 0, 0}, 0},
        {BODY("1", OLDER("")), {0, 0, 0}, 0},
        {BODY("1", OLDER("\"multiscatterColor\":[0.9,0.5,0.7],"
                         "\"scatterAnisotropy\":0.4")),
         {0.9, 0.5, 0.7},
         0.4},
        {BODY("1", OLDER("\"multiscatterColorFactor\":[0.9,0.5,0.7],"
                         "\"scatterAnisotropy\":-0.4")),
         {0.9, 0.5, 0.7},
         -0.4},
        {BODY("1", NEWER("")), {0, 0, 0}, 0},
        {BODY("1", NEWER("\"scatterStrengthFactor\":0.5")), {0.5, 0.5, 0.5}, 0},
        {BODY("1", NEWER("\"scatterStrengthFactor\":0.5,"
                         "\"multiscatterColor\":[1,0.4,0],"
                         "\"scatterAnisotropy\":1")),
         {0.5, 0.2, 0},
         0.999},
        {BODY("1", NEWER("\"scatterStrengthFactor\":1,"
                         "\"multiscatterColorFactor\":[0.3,0.4,0.5]")
                       OLDER("\"multiscatterColor\":[1,1,1],"
                             "\"scatterAnisotropy\":0.9")),
         {0.3, 0.4, 0.5},
         0},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double *c = cases[i].color, g = cases[i].cosine;
        const struct medium *m;
        struct loaded l;

        load_text(&l, cases[i].material);
        assert_true(l.ok);
        assert_int_equal(l.report.entry_count, 0);
        m = &l.scene.materials[1].medium;
        check_close((double)m->extinction.x, log(2) / 2, 1e-6);
        check_close((double)m->extinction.y, log(2), 1e-6);
        check_close((double)m->extinction.z, 0, 0);
        check_close((double)m->anisotropy, g, 1e-6);
        check_close((double)m->scattering.x,
                    c[0] > 0 ? log(2) / 2 * single_scattering(c[0], g) : 0,
                    1e-5);
        check_close((double)m->scattering.y,
                    c[1] > 0 ? log(2) * single_scattering(c[1], g) : 0, 1e-5);
        check_close((double)m->scattering.z, 0, 0);
        unload(&l);
    }
}

/* A diffuse surface of color 0.5, 0.25, 1 with diffuse transmission of color 1,
 * 0.5, 1 before an attenuation of 0.5 0.25 1 after a distance of 2. */
#define LEAF(thickness, weight, core, drafts)                              \
    "{\"pbrMetallicRoughness\":{" core "\"metallicFactor\":0,"             \
    "\"baseColorFactor\":[0.5,0.25,1,1]},"                                 \
    "\"extensions\":{\"KHR_materials_diffuse_transmission\":{"             \
    "\"diffuseTransmissionFactor\":" weight                                \
    ",\"diffuseTransmissionColorFactor\":[1,0.5,1],"                       \
    "\"diffuseTransmissionTexture\":{\"index\":0},"                        \
    "\"diffuseTransmissionColorTexture\":{\"index\":1}},"                  \
    "\"KHR_materials_volume\":{\"thicknessFactor\":" thickness             \
    ",\"attenuationDistance\":2,\"attenuationColor\":[0.5,0.25,1]}" drafts \
    "}}"

/* A medium behind diffuse transmission is one below the surface. A thick body
 * has the color of scattering after two ways through the surface, and what the
 * surface reflects. */
static void media_lie_behind_diffuse_transmission(void **state)
{
    static const struct {
        const char *material;
        double weight;
    } cases[] = {
        {LEAF("1", "1", "",
              OLDER("\"multiscatterColor\":[0.9,0.8,0.4],"
                    "\"scatterAnisotropy\":0.4")),
         1},
        {LEAF("1", "0.25", "",
              OLDER("\"multiscatterColorFactor\":[0.9,0.8,0.4],"
                    "\"scatterAnisotropy\":0.4")),
         0.25},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double w = cases[i].weight;
        const struct material *m;
        struct loaded l;

        load_text(&l, cases[i].material);
        assert_true(l.ok);
        assert_int_equal(l.report.entry_count, 0);
        m = &l.scene.materials[1];
        check_close((double)m->subsurface, w, 0);
        check_close((double)m->translucency, 0, 0);
        check_close((double)m->medium.extinction.x, log(2) / 2, 1e-6);
        check_close((double)m->medium.extinction.y, log(2), 1e-6);
        check_close((double)m->medium.extinction.z, 0, 1e-29);
        check_close((double)m->medium.anisotropy, 0.4, 1e-6);
        check_close((double)m->color.x, (1 - w) * 0.5 + w * 0.9, 1e-6);
        check_close((double)m->color.y, (1 - w) * 0.25 + w * 0.2, 1e-6);
        check_close((double)m->color.z, (1 - w) + w * 0.4, 1e-6);
        assert_int_equal(texture_of(&l, m->subsurface_texture)->channel,
                         CHANNEL_ALPHA);
        assert_int_equal(texture_of(&l, m->color_texture)->is_data, 0);
        unload(&l);
    }
}

/* A white attenuation means that there is no medium. */
static void leaves_without_a_medium_transmit(void **state)
{
    struct loaded l;

    (void)state;
    load_text(&l, "{\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
                  "\"extensions\":{\"KHR_materials_diffuse_transmission\":"
                  "{\"diffuseTransmissionFactor\":1},\"KHR_materials_volume\":"
                  "{\"thicknessFactor\":1,\"attenuationDistance\":1}" OLDER(
                      "\"multiscatterColor\":[1,1,1]") "}}");
    assert_true(l.ok);
    assert_int_equal(l.report.entry_count, 0);
    check_close((double)l.scene.materials[1].subsurface, 0, 0);
    check_close((double)l.scene.materials[1].translucency, 1, 0);
    unload(&l);
}

/* Thin walls that scatter: of what is transmitted, the strength is diffuse. It
 * has the color of scattering, and (1 + cosine) / 2 of it goes on. */
static void thin_walls_scatter(void **state)
{
    static const double weights[] = {1, 0.75, 1, 0.5};
    static const double strengths[] = {1, 0.5, 0.25, 1};
    static const double cosines_of[] = {0.5, -0.5, 1, 1};

    (void)state;
    for (int i = 0; i < 4; i++) {
        double t = weights[i], strength = strengths[i], g = cosines_of[i];
        double rest = t * (1 - strength), front, behind;
        char text[512];
        const struct material *m;
        struct loaded l;

        snprintf(
            text, sizeof text,
            "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,"
            "\"baseColorFactor\":[0.2,0.2,0.2,1]},\"extensions\":{"
            "\"KHR_materials_transmission\":{\"transmissionFactor\":%g}" NEWER(
                "\"scatterStrengthFactor\":%g,"
                "\"multiscatterColorFactor\":[0.9,0.8,0.4],"
                "\"scatterAnisotropy\":%g") "}}",
            t, strength, g);
        load_text(&l, text);
        assert_true(l.ok);
        assert_int_equal(l.report.entry_count, 0);
        m = &l.scene.materials[1];
        check_close((double)m->transmission, rest, 1e-6);
        assert_int_equal(m->is_thin, rest > 0);
        behind = (1 - rest) * (double)(m->translucency * m->back_color.x);
        front = (1 - rest) * (double)((1 - m->translucency) * m->color.x);
        check_close(behind, t * strength * 0.9 * (1 + g) / 2, 1e-6);
        check_close(front, (1 - t) * 0.2 + t * strength * 0.9 * (1 - g) / 2,
                    1e-6);
        unload(&l);
    }
}

/* What a draft says and glim does not render is named. */
static void drafts_are_used_with_warnings(void **state)
{
    static const struct {
        const char *material, *warning;
    } cases[] = {
        {"{\"extensions\":{\"KHR_materials_volume\":{\"thicknessFactor\":"
         "1}" NEWER("\"scatterStrengthFactor\":1") "}}",
         "a.gltf: found scattering without KHR_materials_transmission and a "
         "thick KHR_materials_volume: ignored"},
        {LEAF("0", "1", "", OLDER("\"multiscatterColor\":[1,1,1]")),
         "a.gltf: found scattering without KHR_materials_transmission and a "
         "thick KHR_materials_volume: ignored"},
        {LEAF("1", "1", "\"baseColorTexture\":{\"index\":0},",
              OLDER("\"multiscatterColor\":[1,1,1]")),
         "a.gltf: found baseColorTexture, which also multiplies the color of "
         "scattering behind KHR_materials_diffuse_transmission"},
        {BODY("0", OLDER("\"multiscatterColor\":[1,1,1]")),
         "a.gltf: found scattering without KHR_materials_transmission and a "
         "thick KHR_materials_volume: ignored"},
        {"{\"extensions\":{\"KHR_materials_volume\":{\"thicknessFactor\":"
         "1}" OLDER("\"multiscatterColor\":[1,1,1]") "}}",
         "a.gltf: found scattering without KHR_materials_transmission and a "
         "thick KHR_materials_volume: ignored"},
        {BODY("1", NEWER("\"scatterStrengthFactor\":1,"
                         "\"scatterStrengthTexture\":{\"index\":0}")),
         "a.gltf: found textures of scattering: not used"},
        {BODY("1", NEWER("\"scatterStrengthFactor\":1,"
                         "\"multiscatterColorTexture\":{\"index\":0}")),
         "a.gltf: found textures of scattering: not used"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct loaded l;

        load_text(&l, cases[i].material);
        assert_true(l.ok);
        assert_int_equal(l.report.entry_count, 1);
        assert_string_equal(l.report.entries[0].text, cases[i].warning);
        unload(&l);
    }
}

#define TRANSFORMED                                                           \
    "{\"index\":1,\"texCoord\":1,\"extensions\":{\"KHR_texture_transform\":{" \
    "\"offset\":[0.1,0.7],\"rotation\":1.3,\"scale\":[2,-3]}}}"

/* A material of all extensions and textures, with a name. */
static const char all_of_it[] =
    "{\"name\":\"all of it\",\"alphaMode\":\"MASK\",\"pbrMetallicRoughness\":"
    "{\"baseColorFactor\":[0.1,0.2,0.3,0.9],\"metallicFactor\":0.3,"
    "\"baseColorTexture\":" TRANSFORMED ",\"metallicRoughnessTexture\":"
    "{\"index\":0}},\"normalTexture\":{\"index\":0,\"scale\":0.7},"
    "\"emissiveFactor\":[1,0.5,0.2],\"emissiveTexture\":" TRANSFORMED
    ",\"extensions\":{\"KHR_materials_emissive_strength\":{"
    "\"emissiveStrength\":7},\"KHR_materials_ior\":{\"ior\":2.4},"
    "\"KHR_materials_specular\":{\"specularFactor\":0.8,"
    "\"specularColorFactor\":[1,0.5,0.3],\"specularTexture\":" TRANSFORMED
    ",\"specularColorTexture\":{\"index\":0}},\"KHR_materials_transmission\":"
    "{\"transmissionFactor\":0.6,\"transmissionTexture\":{\"index\":1}},"
    "\"KHR_materials_diffuse_transmission\":{\"diffuseTransmissionFactor\":0.4,"
    "\"diffuseTransmissionColorFactor\":[0.9,0.5,0.1],"
    "\"diffuseTransmissionTexture\":{\"index\":1},"
    "\"diffuseTransmissionColorTexture\":{\"index\":0}},"
    "\"KHR_materials_volume\":{\"thicknessFactor\":1,"
    "\"attenuationDistance\":0.3,\"attenuationColor\":[0.3,0.6,0.9]},"
    "\"KHR_materials_volume_scatter\":{\"multiscatterColor\":"
    "[0.8,0.7,0.1],\"scatterAnisotropy\":0.6},"
    "\"KHR_materials_dispersion\":{\"dispersion\":0.3},"
    "\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.4,"
    "\"clearcoatRoughnessFactor\":0.2,\"clearcoatTexture\":{\"index\":0},"
    "\"clearcoatRoughnessTexture\":{\"index\":1}},\"KHR_materials_sheen\":{"
    "\"sheenColorFactor\":[0.2,0.4,0.1],\"sheenRoughnessFactor\":0.6,"
    "\"sheenColorTexture\":{\"index\":1},\"sheenRoughnessTexture\":{"
    "\"index\":1}},\"KHR_materials_anisotropy\":{\"anisotropyStrength\":0.5,"
    "\"anisotropyRotation\":0.9,\"anisotropyTexture\":{\"index\":1}},\"KHR_"
    "materials_iridescence\":{"
    "\"iridescenceFactor\":0.7,\"iridescenceTexture\":{\"index\":1},"
    "\"iridescenceThicknessTexture\":{\"index\":1}}}}";

/* What the panel saves in the MTL file beside the scene gives the same material
 * with the same textures. */
static void saved_materials_are_the_same(void **state)
{
    struct loaded l;
    struct mtl_change change = {.copied_from = NULL};
    struct material before;
    uint32_t texture_count;
    size_t size_bytes;
    char *text;

    (void)state;
    load_text(&l, all_of_it);
    if (!l.ok)
        print_error("%s\n", l.err.text);
    assert_true(l.ok);
    assert_int_equal(l.report.entry_count, 0);
    before = l.scene.materials[1];
    texture_count = l.scene.texture_count;
    change.name = "all of it";
    change.before = change.after = &l.scene.material_origins[1].source;
    assert_true(mtl_rewrite(&l.scene, &(struct file_bytes){"a.gltf.mtl", "", 0},
                            (struct mtl_changes){&change, 1}, &text,
                            &size_bytes, &l.err));
    assert_true(
        mtl_parse(&l.scene, text, size_bytes, "a.gltf.mtl", &l.report, &l.err));
    assert_int_equal(l.scene.texture_count, texture_count);
    assert_memory_equal(&l.scene.materials[1], &before, sizeof before);
    for (int i = 0; i < l.report.entry_count; i++)
        assert_non_null(strstr(l.report.entries[i].text, "again"));
    free(text);
    unload(&l);
}

static void wrong_values_have_messages(void **state)
{
    static const struct {
        const char *material, *message;
    } cases[] = {
        {"{\"normalTexture\":{\"index\":2}}",
         "a.gltf: /materials/0/normalTexture/index: found 2, expected one of "
         "2 textures"},
        {"{\"normalTexture\":{}}",
         "a.gltf: /materials/0/normalTexture: found no index, expected the "
         "number of a texture"},
        {"{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1]}}",
         "a.gltf: /materials/0/pbrMetallicRoughness/baseColorFactor: found an "
         "array of 2, expected an array of 4 numbers"},
        {BODY("1", OLDER("\"multiscatterColor\":[1]")),
         "a.gltf: /materials/0/extensions/KHR_materials_volume_scatter/"
         "multiscatterColor: found an array of 1, expected an array of 3 "
         "numbers"},
        {BODY("1", NEWER("\"scatterAnisotropy\":true")),
         "a.gltf: /materials/0/extensions/KHR_materials_scatter/"
         "scatterAnisotropy: found true, expected a number"},
        {"{\"alphaMode\":1}",
         "a.gltf: /materials/0/alphaMode: found 1, expected a string"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct loaded l;

        load_text(&l, cases[i].material);
        assert_false(l.ok);
        assert_string_equal(l.err.text, cases[i].message);
        unload(&l);
    }
}

int main(void)
{
    const struct CMUnitTest shared[] = {
        cmocka_unit_test(values_are_those_of_an_independent_reader),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_are_those_of_the_extension),
        cmocka_unit_test(images_are_listed_once),
        cmocka_unit_test(factors_become_values),
        cmocka_unit_test(leaves_have_two_textures),
        cmocka_unit_test(drafts_scatter_what_is_attenuated),
        cmocka_unit_test(media_lie_behind_diffuse_transmission),
        cmocka_unit_test(leaves_without_a_medium_transmit),
        cmocka_unit_test(thin_walls_scatter),
        cmocka_unit_test(drafts_are_used_with_warnings),
        cmocka_unit_test(saved_materials_are_the_same),
        cmocka_unit_test(wrong_values_have_messages),
    };

    return cmocka_run_group_tests(shared, NULL, NULL) +
           cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
