// SPDX-License-Identifier: MIT
/* test_truth_lamps.c - surfaces under lamps against closed forms and quadrature
 * over the lamps */
#include "tests/unit/check.h"
#include "tests/unit/lambert.h"
#include "tests/unit/truth.h"

#define ALBEDO 0.6

enum { FLOOR, LAMP, SCREEN, OTHER };

/* Polygons of five corners are below, above and beside the receiver, whose
 * plane cuts off up to four of the corners. */
static void polygons_obey_lambert(void **state)
{
    const struct receiver receivers[] = {
        {{0, 0, 0}, {0, 1, 0}, false, false},
        {{0.3f, 0.9f, -0.2f}, {0, -1, 0}, false, false},
        {{0.1f, 0.1f, 0.2f}, {0.8f, 0.6f, 0}, false, false},
        {{0, 0.2f, -0.3f}, {0.6f, 0, 0.8f}, false, false},
        {{-0.2f, 0.7f, 0.1f}, {0.96f, -0.28f, 0}, false, false},
    };
    const struct vec3 corners[5] = {{0.6f, 0.4f, 0},
                                    {0.2f, 0.5f, 0.55f},
                                    {-0.5f, 0.675f, 0.35f},
                                    {-0.5f, 0.675f, -0.35f},
                                    {0.2f, 0.5f, -0.55f}};

    (void)state;
    for (size_t k = 0; k < 2 * sizeof receivers / sizeof *receivers; k++) {
        const struct receiver *r = &receivers[k / 2];
        struct lit_mesh s = {0};
        struct mesh *m = &s.mesh;

        m->materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
        m->materials[LAMP] = lamp_material(5);
        add_receiver(m, r->p, r->n);
        for (int i = 1; i < 4; i++) /* both windings */
            mesh_add(m, corners[0], corners[k % 2 ? i : i + 1],
                     corners[k % 2 ? i + 1 : i], LAMP);
        lit_mesh_finish(&s);
        check_receiver(&s, r, ALBEDO, 5 * lambert(corners, 5, r), 2048);
        lit_mesh_free(&s);
    }
}

/* A level rectangle between x0, x1 and z0, z1 at height y. */
struct sheet {
    float x0, x1, z0, z1, y;
};

static void add_sheet(struct mesh *m, struct sheet s, uint32_t material)
{
    mesh_add_quad(m, v3(s.x0, s.y, s.z0), v3(s.x1, s.y, s.z0),
                  v3(s.x1, s.y, s.z1), v3(s.x0, s.y, s.z1), material);
}

static double sheet_irradiance(struct sheet s, const struct receiver *r)
{
    const struct vec3 corners[4] = {{s.x0, s.y, s.z0},
                                    {s.x1, s.y, s.z0},
                                    {s.x1, s.y, s.z1},
                                    {s.x0, s.y, s.z1}};

    return lambert(corners, 4, r);
}

/* Returns the part of a sheet that another one hides from p below both. */
static struct sheet hidden_part(struct sheet lamp, struct sheet screen,
                                struct vec3 p)
{
    float f = (lamp.y - p.y) / (screen.y - p.y);
    struct sheet h = {f_max(lamp.x0, p.x + (screen.x0 - p.x) * f),
                      f_min(lamp.x1, p.x + (screen.x1 - p.x) * f),
                      f_max(lamp.z0, p.z + (screen.z0 - p.z) * f),
                      f_min(lamp.z1, p.z + (screen.z1 - p.z) * f), lamp.y};

    return h;
}

static const struct sheet ceiling = {-0.6f, 0.6f, -0.5f, 0.5f, 0.8f};
static const struct sheet screen = {-0.1f, 0.25f, -0.15f, 0.2f, 0.4f};

/* A lamp is behind a screen that lets a share of the rays pass and emits or
 * not, seen from points inside and outside its shadow. */
static void screens_hide_their_share(void **state)
{
    const float opacities[] = {1, 0.3f};
    const float glows[] = {0, 3};
    const struct receiver receivers[] = {
        {{0, 0, 0}, {0, 1, 0}, false, false},
        {{-0.4f, 0.05f, 0.1f}, {0.6f, 0.8f, 0}, false, false}};

    (void)state;
    for (size_t k = 0; k < 8; k++) {
        const struct receiver *r = &receivers[k & 1];
        float opacity = opacities[k >> 1 & 1];
        float glow = glows[k >> 2];
        struct sheet hidden = hidden_part(ceiling, screen, r->p);
        struct lit_mesh s = {0};
        struct mesh *m = &s.mesh;

        m->materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
        m->materials[LAMP] = lamp_material(2);
        m->materials[SCREEN] = lamp_material(glow);
        m->materials[SCREEN].opacity = opacity;
        m->world.settings.features = FEATURE_COVERAGE;
        add_receiver(m, r->p, r->n);
        add_sheet(m, ceiling, LAMP);
        add_sheet(m, screen, SCREEN);
        lit_mesh_finish(&s);
        check_receiver(&s, r, ALBEDO,
                       2 * sheet_irradiance(ceiling, r) +
                           (double)opacity *
                               ((double)glow * sheet_irradiance(screen, r) -
                                2 * sheet_irradiance(hidden, r)),
                       512);
        lit_mesh_free(&s);
    }
}

/* Sets u from 0 at x0 to 1 at x1 on the last two triangles. */
static void add_uvs(struct mesh *m)
{
    static const struct vec2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

    m->world.uvs = uvs;
    memcpy(m->tris[m->tri_count - 2].vt, (uint32_t[]){0, 1, 2},
           sizeof m->tris->vt);
    memcpy(m->tris[m->tri_count - 1].vt, (uint32_t[]){0, 2, 3},
           sizeof m->tris->vt);
}

/* Texels of the map in a row. Between two of them it is interpolated. */
#define CUT_WIDTH 512

/* A map keeps only the right half of a sheet: of the screen or of the lamp. */
static void cut_outs_hide_and_shine_by_half(void **state)
{
    static uint32_t texels[CUT_WIDTH];
    static const float linear[256] = {0};
    const struct texture half = {.width = CUT_WIDTH,
                                 .height = 1,
                                 .has_alpha = 1,
                                 .scale = {1, 1},
                                 .flags = TEXTURE_CLAMP};
    const struct receiver r = {{0.1f, 0, 0}, {0, 1, 0}, false, false};

    (void)state;
    for (int i = CUT_WIDTH / 2; i < CUT_WIDTH; i++)
        texels[i] = 0xff000000u;
    for (uint32_t cut = LAMP; cut <= SCREEN; cut++) {
        struct sheet lamp = ceiling, shade = screen;
        struct sheet *sheet = cut == LAMP ? &lamp : &shade;
        struct lit_mesh s = {0};
        struct mesh *m = &s.mesh;

        m->materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
        m->materials[LAMP] = lamp_material(2);
        m->materials[SCREEN] = lamp_material(0);
        m->materials[cut].opacity_texture = 0;
        m->world.settings.features = FEATURE_COVERAGE | FEATURE_TEXTURES;
        m->world.textures = &half;
        m->world.texels = texels;
        m->world.linear_of_srgb = linear;
        add_receiver(m, r.p, r.n);
        add_sheet(m, ceiling, LAMP);
        if (cut == LAMP)
            add_uvs(m);
        add_sheet(m, screen, SCREEN);
        if (cut == SCREEN)
            add_uvs(m);
        sheet->x0 = (sheet->x0 + sheet->x1) / 2;
        lit_mesh_finish(&s);
        check_receiver(&s, &r, ALBEDO,
                       2 * (sheet_irradiance(lamp, &r) -
                            sheet_irradiance(hidden_part(lamp, shade, r.p),
                                             &r)),
                       1024);
        lit_mesh_free(&s);
    }
}

/* Returns the radiance towards wo, in a BSDF's frame, of a floor at the origin
 * under a sheet of radiance 1, by midpoints. */
static struct vec3 reflected(const struct bsdf *b, struct vec3 wo,
                             struct sheet lamp)
{
    const int side = 400;
    double sums[3] = {0};
    double area = (double)((lamp.x1 - lamp.x0) * (lamp.z1 - lamp.z0));

    for (int i = 0; i < side * side; i++) {
        struct vec3 p =
            v3(lamp.x0 + (lamp.x1 - lamp.x0) * ((float)(i % side) + 0.5f) /
                             (float)side,
               lamp.y,
               lamp.z0 + (lamp.z1 - lamp.z0) * ((float)(i / side) + 0.5f) /
                             (float)side);
        struct vec3 wi = v3_unit(p);
        double d2 = (double)v3_dot(p, p);
        /* y is up there, and z in a BSDF's frame. Radiance inside glass is its
         * index squared times that outside. */
        double g = fabs((double)wi.y) / d2 * area / (side * side) *
                   (wi.y < 0 && bsdf_is_solid(b) ? pow((double)b->eta, -2) : 1);
        float pdf;
        struct vec3 f = bsdf_terms(b, wo, v3(wi.x, wi.z, wi.y), &pdf);

        sums[0] += (double)f.x * g;
        sums[1] += (double)f.y * g;
        sums[2] += (double)f.z * g;
    }
    return v3((float)sums[0], (float)sums[1], (float)sums[2]);
}

/* Tests a surface of each kind, except mirrors, between a lamp above and one
 * below, from both sides. The smooth face's mirror image shows neither lamp. */
static void all_surfaces_shine_as_they_scatter(void **state)
{
    const struct {
        uint32_t kind;
        float alpha, translucency;
    } kinds[] = {
        {MATERIAL_DIFFUSE, 0, 0},       {MATERIAL_ROUGH_DIFFUSE, 0.7f, 0},
        {MATERIAL_METAL, 0.5f, 0},      {MATERIAL_PLASTIC, 0, 0},
        {MATERIAL_PLASTIC, 0.4f, 0},    {MATERIAL_GLASS, 0.7f, 0},
        {MATERIAL_GLASS, 1, 0},         {MATERIAL_THIN_GLASS, 0.5f, 0},
        {MATERIAL_DIFFUSE, 0, 0.4f},    {MATERIAL_PLASTIC, 0, 0.4f},
        {MATERIAL_PLASTIC, 0.4f, 0.6f}, {MATERIAL_ROUGH_DIFFUSE, 1, 0.5f}};
    const struct sheet lamps[2] = {{-0.7f, 0.3f, 0.05f, 0.7f, 0.5f},
                                   {-0.5f, 0.2f, 0.05f, 0.4f, -0.4f}};

    (void)state;
    for (size_t k = 0; k < 2 * sizeof kinds / sizeof *kinds; k++) {
        struct material floor = mesh_material(kinds[k / 2].kind, 1);
        struct vec3 wo = v3(0.6f, 0, k % 2 ? -0.8f : 0.8f);
        struct vec3 truth = {0, 0, 0};
        struct lit_mesh s = {0};
        struct bsdf b;

        floor.color = v3(0.9f, 0.6f, 0.3f);
        floor.specular = v3(0.04f, 0.04f, 0.04f);
        floor.alpha = kinds[k / 2].alpha;
        floor.back_color = v3(0.2f, 0.5f, 0.9f);
        floor.translucency = kinds[k / 2].translucency;
        s.mesh.materials[FLOOR] = floor;
        s.mesh.materials[LAMP] = lamp_material(1);
        mesh_add_quad(&s.mesh, v3(-0.01f, 0, 0.01f), v3(0.01f, 0, 0.01f),
                      v3(0.01f, 0, -0.01f), v3(-0.01f, 0, -0.01f), FLOOR);
        b = (struct bsdf){.color = floor.color,
                          .specular = floor.specular,
                          .alpha = floor.alpha,
                          .kind = floor.kind,
                          .back_color = floor.back_color,
                          .translucency = floor.translucency,
                          .eta = wo.z > 0 || floor.kind == MATERIAL_THIN_GLASS
                                     ? 1.5f
                                     : 1 / 1.5f};
        for (int i = 0; i < 2; i++) {
            struct sheet seen = lamps[i];

            add_sheet(&s.mesh, lamps[i], LAMP);
            if (wo.z < 0) /* from below, everything is reversed */
                seen.y = -seen.y;
            truth = v3_add(truth, reflected(&b, v3(wo.x, 0, 0.8f), seen));
        }
        lit_mesh_finish(&s);
        check_claim(&s,
                    ((struct claim){.eye = v3(0.06f, wo.z / 10, 0),
                                    .truth = {(double)truth.x, (double)truth.y,
                                              (double)truth.z},
                                    /* Error of the midpoints. */
                                    .systematic = 1e-4,
                                    .paths = 4096}));
        lit_mesh_free(&s);
    }
}

/* 300 lamps of three radiances are side by side in a plane. */
static void many_lamps_add_up(void **state)
{
    const struct receiver receivers[] = {
        {{0, 0, 0}, {0, 1, 0}, false, false},
        {{0.5f, 0.2f, -0.3f}, {-0.6f, 0.8f, 0}, false, false}};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        const struct receiver *r = &receivers[k];
        struct lit_mesh s = {0};
        double irradiance = 0;
        uint64_t seed = 15;

        s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, ALBEDO);
        for (uint32_t i = LAMP; i <= OTHER; i++)
            s.mesh.materials[i] = lamp_material((float)(i * i));
        add_receiver(&s.mesh, r->p, r->n);
        for (uint32_t i = 0; i < 300; i++) {
            float x = (float)(i % 20) / 10 - 1, z = (float)(i / 20) / 7.5f - 1;
            float size = 0.01f + 0.08f * (float)check_random(&seed);
            const struct vec3 p[3] = {{x, 0.6f, z},
                                      {x + size, 0.6f, z},
                                      {x, 0.6f, z + size}};
            uint32_t lamp = LAMP + i % 3;

            mesh_add(&s.mesh, p[0], p[1], p[2], lamp);
            irradiance += lamp * lamp * lambert(p, 3, r);
        }
        lit_mesh_finish(&s);
        check_receiver(&s, r, ALBEDO, irradiance, 4096);
        lit_mesh_free(&s);
    }
}

/* A wall with a mirror lights the floor like the lamp's image behind it, which
 * only BSDF samples find. */
static void mirrors_show_lamps_to_floors(void **state)
{
    const struct receiver r = {{0.2f, 0, 0.1f}, {0, 1, 0}, false, false};
    const struct sheet lamp = {0.1f, 0.5f, -0.3f, 0.3f, 0.4f};
    const struct sheet image = {-0.5f, -0.1f, -0.3f, 0.3f, 0.4f};
    struct lit_mesh s = {0};

    (void)state;
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    s.mesh.materials[LAMP] = lamp_material(2);
    s.mesh.materials[SCREEN] = mesh_material(MATERIAL_METAL, 1);
    add_receiver(&s.mesh, r.p, r.n);
    add_sheet(&s.mesh, lamp, LAMP);
    mesh_add_quad(&s.mesh, v3(0, 0, -1), v3(0, 1, -1), v3(0, 1, 1), v3(0, 0, 1),
                  SCREEN);
    lit_mesh_finish(&s);
    check_receiver(&s, &r, ALBEDO,
                   2 * (sheet_irradiance(lamp, &r) +
                        sheet_irradiance(image, &r)),
                   1024);
    /* The floor's own image. */
    check_claim(&s,
                ((struct claim){.eye = v3(0.3f, 0.1f, 0.1f),
                                .at = v3(-r.p.x, r.p.y, r.p.z),
                                .truth = GREY(ALBEDO / M_PI * 2 *
                                              (sheet_irradiance(lamp, &r) +
                                               sheet_irradiance(image, &r))),
                                .paths = 1024}));
    lit_mesh_free(&s);
}

/* Everything is inside glass, seen from inside and from outside. A face
 * transmits .96 along its normal, and radiance outside is less by the index
 * squared. */
static void glass_dims_what_is_in_it(void **state)
{
    const struct receiver r = {{0, 0, 0}, {0, 1, 0}, false, false};
    const struct sheet lamp = {0.05f, 0.6f, -0.3f, 0.3f, 0.4f};
    double truth = ALBEDO / M_PI * 2 * sheet_irradiance(lamp, &r);
    struct lit_mesh s = {0};

    (void)state;
    s.mesh.materials[FLOOR] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    s.mesh.materials[LAMP] = lamp_material(2);
    s.mesh.materials[OTHER] = mesh_material(MATERIAL_GLASS, 1);
    add_receiver(&s.mesh, r.p, r.n);
    add_sheet(&s.mesh, lamp, LAMP);
    mesh_add_box(&s.mesh, v3(-1, -1, -1), v3(1, 1, 1), OTHER);
    /* Without light reflected by the faces. */
    s.mesh.world.settings.max_vertices = 2;
    lit_mesh_finish(&s);
    check_receiver(&s, &r, ALBEDO, 2 * sheet_irradiance(lamp, &r), 1024);
    s.mesh.world.settings.max_vertices = 3;
    check_claim(&s, ((struct claim){.eye = {0, 2, 0},
                                    .truth = GREY(truth * 0.96 / (1.5 * 1.5)),
                                    .paths = 2048}));
    lit_mesh_free(&s);
}

/* Makes a room with a glossy ball, a block of glass and four lamps, of which
 * one is on, or all if `lit` is NO_INDEX. */
static void make_room(struct lit_mesh *s, uint32_t lit)
{
    struct mesh *m = &s->mesh;

    m->materials[0] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
    m->materials[1] = mesh_material(MATERIAL_METAL, 0.8f);
    m->materials[1].alpha = 0.3f;
    m->materials[2] = mesh_material(MATERIAL_GLASS, 1);
    mesh_add_box(m, v3(-1, -1, -1), v3(1, 1, 1), 0);
    mesh_add_sphere(m, v3(-0.4f, -0.6f, -0.3f), 0.4f, 8, 12, 1);
    mesh_add_box(m, v3(0.2f, -0.9f, -0.5f), v3(0.6f, -0.1f, -0.1f), 2);
    for (uint32_t i = 0; i < 4; i++) {
        float x = i % 2 ? 0.2f : -0.8f, z = i / 2 ? 0.1f : -0.7f;
        struct sheet lamp = {x, x + 0.5f, z, z + 0.4f, 0.5f + 0.1f * (float)i};

        m->materials[3 + i] = mesh_material(MATERIAL_DIFFUSE, (float)ALBEDO);
        if (lit == i || lit == NO_INDEX)
            m->materials[3 + i].emission =
                v3((float)i + 1, 2, 3 - 0.5f * (float)i);
        add_sheet(m, lamp, 3 + i);
    }
    lit_mesh_finish(s);
}

/* The radiance of all lamps is the sum of those of single ones. */
static void lamps_add_up_one_by_one(void **state)
{
    const struct vec3 places[] = {{0.4f, -1, -0.3f},
                                  {-0.4f, -0.5f, -0.2f},
                                  {-1, 0.1f, 0.2f}};

    (void)state;
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        struct claim c = {.eye = {0.3f, 0.2f, 0.8f},
                          .at = places[k],
                          .paths = 2048};
        struct estimate all = {{0}, {0}}, sum = {{0}, {0}};

        for (uint32_t lit = 0; lit <= 4; lit++) {
            struct lit_mesh s = {0};
            struct estimate e;

            make_room(&s, lit < 4 ? lit : NO_INDEX);
            lit_mesh_lend(&s, DIRECT_MIS);
            e = claim_estimate(&s.mesh.world, &c);
            lit_mesh_free(&s);
            if (lit == 4)
                all = e;
            for (int i = 0; lit < 4 && i < 3; i++) {
                sum.mean[i] += e.mean[i];
                sum.error[i] = hypot(sum.error[i], e.error[i]);
            }
        }
        for (int i = 0; i < 3; i++) {
            double error = hypot(all.error[i], sum.error[i]);

            check_close(all.mean[i], sum.mean[i], T_LIMIT * error);
            check_at_most(error, PRECISION * sum.mean[i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_obey_lambert),
        cmocka_unit_test(screens_hide_their_share),
        cmocka_unit_test(cut_outs_hide_and_shine_by_half),
        cmocka_unit_test(all_surfaces_shine_as_they_scatter),
        cmocka_unit_test(many_lamps_add_up),
        cmocka_unit_test(mirrors_show_lamps_to_floors),
        cmocka_unit_test(glass_dims_what_is_in_it),
        cmocka_unit_test(lamps_add_up_one_by_one),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
