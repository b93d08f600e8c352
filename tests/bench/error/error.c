// SPDX-License-Identifier: MIT
/*
 * error - relative MSE over seconds, with all techniques and with each of them
 * off, with adaptive sampling, with the filter, the gain over glim's first
 * integrator, and the variance by class of path
 *
 * usage: error FOLDER THREADS ROUNDS [PART_OF_A_NAME]
 *
 * Pictures are small, since the cost and the convergence of a pixel do not
 * depend on their number. A curve is one render that is measured after 1, 2, 4,
 * ... samples per pixel. Rounds have their own seeds, and techniques take turns
 * in each, so that a slow minute of the machine affects all of them. Seconds
 * are processor time per thread, which other programs hardly disturb, and
 * medians over the rounds. Errors are means, since they are expectations. The
 * reference's own noise is subtracted.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "command/chart.h"
#include "film/filter/film_filter.h"
#include "classes.h"
#include "reference.h"
#include "terminal/xmalloc.h"
#include "tests/bench/median.h"
#include "world/world.h"

#define POINTS     7 /* 1 to 64 samples a pixel */
#define ROUNDS_MAX MEDIAN_MAX
#define HEIGHT_PX  56

/* References of 256x256 pixels are too large here and are reduced to 64x64. */
#define REDUCE 4

/* Builds of src/render/cpu_kernel.c with one function replaced; see the headers
 * in this folder. */
extern const struct cpu_kernel paths_whole, paths_hashed, paths_uniform,
    paths_throughput, paths_shadows, paths_collisions;

/* Feature that a scene must have for a technique to matter. */
enum need {
    NEED_NOTHING,
    NEED_LIGHT_SAMPLES,
    NEED_LIGHTS,
    NEED_SKY_TABLE,
    NEED_GUIDE,
    NEED_LIGHT_PATHS,
    NEED_MEDIA
};

/* What a render has besides its kernel and settings. */
enum extra {
    GUIDED,
    UNGUIDED,
    ADAPTIVE,
    FILTERED,
    WITHOUT_CELLS,
    WITHOUT_LIGHT_PATHS /* nor cells */
};

/* All techniques that are on by default, or all except the one of this name, or
 * those and this one. */
static const struct technique {
    const char *name;
    const struct cpu_kernel *paths;
    enum direct direct;
    enum sky_use sky_use;
    enum need need;
    enum extra extra;
} techniques[] = {
    {"everything", &paths_whole, DIRECT_MIS, SKY_WITH_MIS, NEED_NOTHING,
     GUIDED},
    {"first integrator", &paths_hashed, DIRECT_BSDF, SKY_WITH_MIS, NEED_NOTHING,
     WITHOUT_LIGHT_PATHS},
    {"without light samples", &paths_whole, DIRECT_BSDF, SKY_WITH_MIS,
     NEED_LIGHT_SAMPLES, GUIDED},
    {"without light by chance", &paths_whole, DIRECT_LIGHTS, SKY_ALONE,
     NEED_LIGHT_SAMPLES, GUIDED},
    {"without sobol points", &paths_hashed, DIRECT_MIS, SKY_WITH_MIS,
     NEED_NOTHING, GUIDED},
    {"without the light tree", &paths_uniform, DIRECT_MIS, SKY_WITH_MIS,
     NEED_LIGHTS, GUIDED},
    {"without compensation", &paths_whole, DIRECT_MIS, SKY_ALONE,
     NEED_SKY_TABLE, GUIDED},
    {"without root in roulette", &paths_throughput, DIRECT_MIS, SKY_WITH_MIS,
     NEED_NOTHING, GUIDED},
    {"with all shadow rays", &paths_shadows, DIRECT_MIS, SKY_WITH_MIS,
     NEED_LIGHT_SAMPLES, GUIDED},
    {"without samples on rays", &paths_collisions, DIRECT_MIS, SKY_WITH_MIS,
     NEED_MEDIA, GUIDED},
    {"without the guide", &paths_whole, DIRECT_MIS, SKY_WITH_MIS, NEED_GUIDE,
     UNGUIDED},
    {"without cells", &paths_whole, DIRECT_MIS, SKY_WITH_MIS, NEED_NOTHING,
     WITHOUT_CELLS},
    {"without light paths", &paths_whole, DIRECT_MIS, SKY_WITH_MIS,
     NEED_LIGHT_PATHS, WITHOUT_LIGHT_PATHS},
    {"with adaptive sampling", &paths_whole, DIRECT_MIS, SKY_WITH_MIS,
     NEED_NOTHING, ADAPTIVE},
    {"with the filter", &paths_whole, DIRECT_MIS, SKY_WITH_MIS, NEED_NOTHING,
     FILTERED},
};

enum { TECHNIQUES = sizeof techniques / sizeof techniques[0] };
enum { EVERYTHING, FIRST_INTEGRATOR };

enum folder { SHIPPED, SHARED, MADE };

/* Scenes that are measured. `goal` is the desired gain over the first
 * integrator: 0.95 is "no worse by more than 5 %". */
static const struct subject {
    const char *name;
    enum folder folder;
    enum direct reference; /* makes the reference, unless another renderer has
                              made it */
    double goal;
} subjects[] = {
    {"cornell", SHIPPED, DIRECT_MIS, 30},
    {"materials", SHIPPED, DIRECT_BSDF, 0.95},
    {"glass_mirror", SHIPPED, DIRECT_MIS, 0.95},
    {"interior", SHIPPED, DIRECT_BSDF, 0.95},
    {"skylit", SHIPPED, DIRECT_MIS, 0.95},
    {"lights200", SHIPPED, DIRECT_MIS, 0.95},
    {"globe", SHIPPED, DIRECT_MIS, 100},
    {"bulb", SHIPPED, DIRECT_MIS, 100},
    {"water", SHIPPED, DIRECT_MIS, 10},
    {"fog", SHIPPED, DIRECT_MIS, 0.95},
    {"milk", SHIPPED, DIRECT_MIS, 0.95},
    {"prism", SHIPPED, DIRECT_MIS, 0.95},
    {"lantern", SHIPPED, DIRECT_MIS, 0.95},
    {"cornell", SHARED, DIRECT_MIS, 30},
    {"many_lights", SHARED, DIRECT_MIS, 0.95},
    {"sky", SHARED, DIRECT_MIS, 0.95},
    {"plates", MADE, DIRECT_MIS, 15},
    {"lamps2000", MADE, DIRECT_MIS, 5},
    {"sun", MADE, DIRECT_MIS, 50},
    {"balls", MADE, DIRECT_MIS, 5},
    {"sunball", MADE, DIRECT_MIS, 100},
    {"coat", MADE, DIRECT_MIS, 0.95},
    {"sheen", MADE, DIRECT_MIS, 0.95},
    {"grain", MADE, DIRECT_MIS, 0.95},
    {"film", MADE, DIRECT_MIS, 0.95},
    {"absorbing", MADE, DIRECT_MIS, 0.95},
    {"frosted", MADE, DIRECT_MIS, 0.95},
};

enum { SUBJECTS = sizeof subjects / sizeof subjects[0] };

/* Measurements of one technique in one scene. */
struct error_curve {
    bool is_measured;
    double seconds[POINTS][ROUNDS_MAX];
    double error[POINTS]; /* sums over rounds, then means */
    double square;        /* sum of squares of the last errors */
    double spread;        /* relative standard error of the last mean */
    double bias;
};

/* Ratio of the first integrator's error to this one's, at equal time. */
struct gain {
    double times;  /* 0: not measured */
    double spread; /* relative standard error */
};

struct bench {
    const char *folder;
    int threads, rounds;
    FILE *csv;
    struct backend *backends[TECHNIQUES];
};

/* The scene that is being measured. */
struct measurement {
    const struct bench *bench;
    struct session session;
    struct sky_table whole_sky; /* of SKY_ALONE */
    struct reference reference;
    float *rgb;
    struct error_curve curves[TECHNIQUES];
};

static bool matters(const struct technique *t, const struct host_world *host,
                    const struct settings *s)
{
    switch (t->need) {
    case NEED_LIGHT_SAMPLES: return s->light_count > 0 || s->sky_share > 0;
    case NEED_LIGHTS: return s->light_count > 1;
    case NEED_SKY_TABLE: return s->sky_share > 0;
    case NEED_GUIDE: return s->guide.table_count > 0;
    case NEED_MEDIA: return (s->features & FEATURE_MEDIA) != 0;
    case NEED_LIGHT_PATHS: return host->light_paths.sources != NULL;
    case NEED_NOTHING: break;
    }
    return true;
}

static bool start(struct render *r, const struct render_job *job,
                  struct error *err)
{
    if (!render_start(r, job, err))
        return false;
    render_wait(r, -1);
    return true;
}

/* Takes the picture of the film, filtered if that is wanted and the film has
 * enough samples. *seconds is the time of the filter. */
static bool take_picture(struct measurement *m, bool is_filtered,
                         double *seconds, struct error *err)
{
    struct film *film = render_film(m->session.engine.render), filtered;
    uint64_t begin_ns = clock_cpu_ns();

    *seconds = 0;
    if (!is_filtered || !film_filter_applies(film)) {
        film_linear(film, m->rgb);
        return true;
    }
    if (!film_filter_copy(film, m->bench->threads, &filtered, err))
        return false;
    *seconds = seconds_between(begin_ns, clock_cpu_ns());
    film_linear(&filtered, m->rgb);
    film_free(&filtered);
    return true;
}

/* Adds one render of a job to a curve; afterwards `rgb` is its picture. */
static bool measure_job(struct measurement *m, struct error_curve *c, int round,
                        const struct render_job *job, enum extra extra,
                        struct error *err)
{
    struct session *s = &m->session;
    double seconds = 0, filter_seconds, error = 0;

    if (!start(s->engine.render, job,
               err)) /* builds the tree, loads the code */
        return false;
    for (int i = 0; i < POINTS; i++) {
        uint64_t begin_ns = clock_cpu_ns();

        if (i > 0) {
            render_resume(s->engine.render,
                          (struct render_limits){.spp = 1ull << i});
            render_wait(s->engine.render, -1);
        } else if (!start(s->engine.render, job, err)) {
            return false;
        }
        seconds += seconds_between(begin_ns, clock_cpu_ns());
        if (!take_picture(m, extra == FILTERED, &filter_seconds, err))
            return false;
        c->seconds[i][round] = (seconds + filter_seconds) / m->bench->threads;
        error = reference_error(&m->reference, m->rgb);
        c->error[i] += error;
    }
    c->square += error * error;
    c->bias += reference_bias(&m->reference, m->rgb);
    return true;
}

/* Adds one render of this world to a curve; afterwards `rgb` is its picture. */
static bool measure_world(struct measurement *m, struct error_curve *c,
                          int round, const struct world *world,
                          enum extra extra, struct error *err)
{
    struct session *s = &m->session;
    struct render_job job = {.world = *world,
                             .host = &s->engine.world,
                             .crop = {0, 0, s->edit.now.view.width_px,
                                      s->edit.now.view.height_px},
                             .limits.spp = 1,
                             .is_adaptive = extra == ADAPTIVE};
    struct light_source *sources = s->engine.world.light_paths.sources;
    bool ok;

    if (extra == WITHOUT_LIGHT_PATHS)
        s->engine.world.light_paths.sources = NULL;
    ok = measure_job(m, c, round, &job, extra, err);
    s->engine.world.light_paths.sources = sources;
    return ok;
}

/* Adds one render of a technique to its curve. */
static bool measure_round(struct measurement *m, int technique, int round,
                          struct error *err)
{
    const struct technique *t = &techniques[technique];
    struct session *s = &m->session;
    struct error_curve *c = &m->curves[technique];
    struct world world;

    if (!world_lend(&s->engine.world, &s->engine.scene, &s->edit.now.view,
                    (uint32_t)round, &world, err))
        return false;
    c->is_measured = matters(t, &s->engine.world, &world.settings);
    if (!c->is_measured)
        return true;
    if (t->sky_use == SKY_ALONE)
        sky_table_lend(&m->whole_sky, &world);
    if (t->extra == FILTERED)
        world.settings.features |= FEATURE_FILTER;
    world.settings.has_light_cells =
        t->extra != WITHOUT_CELLS && t->extra != WITHOUT_LIGHT_PATHS;
    if (t->extra == UNGUIDED || technique == FIRST_INTEGRATOR)
        path_guide_lend(&(struct path_guide){.cells = NULL}, &world);
    world.settings.direct = t->direct;
    render_set_backend(s->engine.render, m->bench->backends[technique]);
    return measure_world(m, c, round, &world, t->extra, err);
}

/* Prints which paths have the variance of a sample. */
static bool print_classes(struct measurement *m, struct error *err)
{
    struct engine *e = &m->session.engine;
    struct class_variance v;
    struct world world;
    double all;

    if (!world_lend(&e->world, &e->scene, &m->session.edit.now.view, 1, &world,
                    err) ||
        !world_ensure_tree(&e->world, &world, NULL, err) ||
        !class_variance_measure(&world, &paths_whole, &v, err))
        return false;
    all = v.light_paths + v.light_cells + v.radiance_cells + v.rest;
    printf("variance of a sample of paths from the eye: %.3g; light paths take "
           "%.1f %%, light cells %.1f %%, radiance cells %.1f %%, %.1f %% is "
           "left\n",
           all, 100 * v.light_paths / all, 100 * v.light_cells / all,
           100 * v.radiance_cells / all, 100 * v.rest / all);
    return true;
}

/* Converts sums over rounds to means without the reference's noise. */
static void finish_curve(struct error_curve *c, int rounds, double noise)
{
    double last = c->error[POINTS - 1] / rounds;
    double variance = (c->square / rounds - last * last) / (rounds - 1);

    for (int i = 0; i < POINTS; i++)
        c->error[i] = c->error[i] / rounds - noise;
    c->spread = sqrt(variance) / c->error[POINTS - 1];
    c->bias /= rounds;
}

static bool measure(struct measurement *m, struct error *err)
{
    int rounds = m->bench->rounds;

    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < TECHNIQUES; i++)
            if (!measure_round(m, i, round, err))
                return false;
    for (int i = 0; i < TECHNIQUES; i++)
        finish_curve(&m->curves[i], rounds, m->reference.noise);
    return true;
}

static struct series series_of(const struct error_curve *c, int rounds)
{
    struct series s = {.count = POINTS};

    for (int i = 0; i < POINTS; i++) {
        s.x[i] = median(c->seconds[i], rounds);
        s.y[i] = c->error[i];
    }
    return s;
}

static void print_curves(const struct measurement *m, const char *name,
                         struct series series[TECHNIQUES])
{
    const struct reference *r = &m->reference;

    printf("\n%s, %dx%d pixels\nreference: %s; its own relative MSE of %.2g is "
           "subtracted\n",
           name, r->width, r->height, r->origin, r->noise);
    printf("%-25s relative MSE after 1, 2, 4 .. %d samples a pixel%17s "
           "%8s %6s %10s %6s %6s\n",
           "", 1 << (POINTS - 1), "+-", "seconds", "slope", "efficiency",
           "ratio", "bias");
    for (int i = 0; i < TECHNIQUES; i++) {
        struct series *s = &series[i];
        double seconds = s->x[POINTS - 1], error = s->y[POINTS - 1];

        if (!m->curves[i].is_measured)
            continue;
        printf("%-25s", techniques[i].name);
        for (int k = 0; k < POINTS; k++)
            printf(" %8.2e", s->y[k]);
        printf(" %3.0f%% %8.3f %6.2f %10.3g %6.3g %5.1f%%\n",
               100 * m->curves[i].spread, seconds, series_fit(s).slope,
               1 / (error * seconds), series_times(&series[EVERYTHING], s),
               100 * m->curves[i].bias);
        for (int k = 0; k < POINTS; k++)
            fprintf(m->bench->csv, "%s,%s,%d,%g,%g,%g,%g\n", name,
                    techniques[i].name, 1 << k, s->x[k], s->y[k], r->noise,
                    1 / (s->x[k] * s->y[k]));
    }
    fflush(stdout);
}

static bool draw_curves(const struct measurement *m, const char *name,
                        const struct series series[TECHNIQUES],
                        struct error *err)
{
    struct series drawn[TECHNIQUES];
    struct chart chart = {.title = name,
                          .x_label = "seconds",
                          .y_label = "relative MSE",
                          .series = drawn};
    char *path = xformat("%s/%s.gp", m->bench->folder, name);
    bool ok;

    for (int i = 0; i < TECHNIQUES; i++)
        if (m->curves[i].is_measured) {
            drawn[chart.series_count] = series[i];
            drawn[chart.series_count++].name = techniques[i].name;
        }
    ok = chart_write(&chart, path, err);
    free(path);
    return ok;
}

static bool find_reference(struct measurement *m, const struct subject *subject,
                           struct error *err)
{
    char *cache;
    bool ok;

    if (subject->folder == SHARED)
        return reference_read(&m->reference, m->session.options->scene_path,
                              REDUCE, err);
    cache = xformat("%s/reference", m->bench->folder);
    ok = reference_make(&m->reference, &m->session, subject->reference, cache,
                        err);
    free(cache);
    return ok;
}

static bool build_whole_sky(struct measurement *m, struct error *err)
{
    const struct host_world *host = &m->session.engine.world;

    return host->sky_texels == NULL ||
           sky_table_build(&m->whole_sky, host->sky_texels, host->sky_width,
                           host->sky_height, SKY_ALONE, err);
}

static bool measure_scene(const struct bench *bench,
                          const struct subject *subject, const char *path,
                          const char *name, struct gain *gain,
                          struct error *err)
{
    struct options o = {.scene_path = path,
                        .height_px = subject->folder == SHARED ? 256 / REDUCE
                                                               : HEIGHT_PX,
                        .thread_count = bench->threads,
                        .max_bounces = -1,
                        .batch = true};
    struct series series[TECHNIQUES];
    struct measurement *m = xcalloc(1, sizeof *m);
    bool ok;

    m->bench = bench;
    ok = session_open(&m->session, &o, clock_ns(), err) &&
         world_guide(&m->session.engine.world, &m->session.engine.scene,
                     &m->session.edit.now.view, err) &&
         find_reference(m, subject, err) && build_whole_sky(m, err);
    if (ok) {
        m->rgb =
            xcalloc((size_t)m->reference.width * (size_t)m->reference.height,
                    3 * sizeof *m->rgb);
        ok = measure(m, err);
    }
    for (int i = 0; ok && i < TECHNIQUES; i++)
        series[i] = series_of(&m->curves[i], bench->rounds);
    if (ok) {
        print_curves(m, name, series);
        ok = m->session.engine.world.light_paths.sources == NULL ||
             print_classes(m, err);
    }
    if (ok) {
        gain->times =
            series_times(&series[EVERYTHING], &series[FIRST_INTEGRATOR]);
        gain->spread = hypot(m->curves[EVERYTHING].spread,
                             m->curves[FIRST_INTEGRATOR].spread);
        ok = draw_curves(m, name, series, err);
    }
    session_close(&m->session);
    sky_table_free(&m->whole_sky);
    reference_free(&m->reference);
    free(m->rgb);
    free(m);
    return ok;
}

static char *path_of(const struct bench *bench, const struct subject *s)
{
    const char *shared = getenv("GLIM_SHARED");

    switch (s->folder) {
    case SHARED:
        return xformat("%s/scenes-bench/%s/%s.obj",
                       shared != NULL ? shared : "../shared", s->name, s->name);
    case MADE: return xformat("%s/scenes/%s.obj", bench->folder, s->name);
    case SHIPPED: break;
    }
    return xformat("scenes/%s.obj", s->name);
}

/* Returns the title in the output and in the name of the diagram. */
static char *title_of(const struct subject *s)
{
    return xformat("%s%s", s->folder == SHARED ? "shared-" : "", s->name);
}

static bool measure_subject(const struct bench *bench, const struct subject *s,
                            const char *filter, struct gain *gain,
                            struct error *err)
{
    char *title = title_of(s);
    char *path = path_of(bench, s);
    bool ok = true;

    if (strstr(title, filter) != NULL) {
        if (access(path, R_OK) == 0)
            ok = measure_scene(bench, s, path, title, gain, err);
        else
            printf("\n%s: skipped, %s is not here\n", title, path);
    }
    free(path);
    free(title);
    return ok;
}

static void print_gains(const struct gain gains[SUBJECTS])
{
    printf("\nError of the first integrator (hashed points, light by chance) "
           "at equal time\n");
    for (int i = 0; i < SUBJECTS; i++) {
        char *title = title_of(&subjects[i]);

        if (gains[i].times > 0)
            printf("%-20s %9.3g times +- %2.0f%%, goal %4g: %s\n", title,
                   gains[i].times, 100 * gains[i].spread, subjects[i].goal,
                   gains[i].times >= subjects[i].goal ? "met" : "NOT MET");
        free(title);
    }
}

static bool measure_all(const struct bench *bench, const char *filter,
                        struct error *err)
{
    struct gain gains[SUBJECTS] = {{0, 0}};

    for (int i = 0; i < SUBJECTS; i++)
        if (!measure_subject(bench, &subjects[i], filter, &gains[i], err))
            return false;
    print_gains(gains);
    return true;
}

int main(int argc, char **argv)
{
    struct bench bench = {.folder = argc > 1 ? argv[1] : "."};
    struct error err;
    char *csv;
    bool ok = true;

    if (argc < 4) {
        fprintf(stderr, "usage: error FOLDER THREADS ROUNDS [NAME]\n");
        return 2;
    }
    bench.threads = (int)strtol(argv[2], NULL, 10);
    bench.rounds = (int)strtol(argv[3], NULL, 10);
    bench.rounds = bench.rounds < 1            ? 1
                   : bench.rounds > ROUNDS_MAX ? ROUNDS_MAX
                                               : bench.rounds;
    csv = xformat("%s/error.csv", bench.folder);
    bench.csv = fopen(csv, "w");
    if (bench.csv == NULL) {
        perror(csv);
        return 1;
    }
    fprintf(bench.csv, "scene,technique,samples,seconds,relative_mse,"
                       "reference_noise,efficiency\n");
    for (int i = 0; ok && i < TECHNIQUES; i++) {
        bench.backends[i] =
            backend_cpu_create(bench.threads, techniques[i].paths, &err);
        ok = bench.backends[i] != NULL;
    }
    printf("%d thread(s), %d rounds; seconds of the processor a thread; "
           "+-: standard error of the last error; efficiency: 1 / (error x "
           "seconds); ratio: error at equal time, over "
           "that of everything; bias: of the mean, against the reference's\n",
           bench.threads, bench.rounds);
    ok = ok && measure_all(&bench, argc > 4 ? argv[4] : "", &err);
    if (!ok)
        fprintf(stderr, "error: %s\n", err.text);
    for (int i = 0; i < TECHNIQUES; i++)
        if (bench.backends[i] != NULL)
            bench.backends[i]->destroy(bench.backends[i]);
    fclose(bench.csv);
    free(csv);
    return ok ? 0 : 1;
}
