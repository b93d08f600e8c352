// SPDX-License-Identifier: MIT
/*
 * error - whether the stated error of a picture is true
 *
 * usage: error [SCENE]
 *
 * Each scene of scenes/ is rendered with RENDERS seeds, which are not those by
 * which the formulas were chosen. At FIRST_SPP and LAST_SPP samples, and where
 * a limit of the error stops the render in between, the 95 % interval of
 * film_error.h must contain the true error of that very picture in 92 to 98 %
 * of the renders. Renders that are marked as unresolved are counted apart. If
 * most are, as for a caustic of which few paths are found, nothing is wanted of
 * the others.
 *
 * The truth needs a reference. For picture x of render k that is the mean r of
 * the last pictures of the other K - 1 renders, which is independent of x. With
 * the true picture t, the mean of (x - r)^2 over the other renders is
 *
 *     (x - t)^2 + v / (K - 1)
 *
 * where v is the variance of a last picture. The cross term (x - t)(r - t) has
 * mean 0 because r is independent of x and unbiased. v is estimated from all K
 * last pictures, and the weighted mean of v / (K - 1) is subtracted. What the
 * cross term adds to the spread of the difference between truth and estimate is
 * (1 / (K - 1)) of its variance, .5 % at 200 renders. Weights have the means of
 * all K renders; the share of x in the 48 pixels of K pictures is negligible.
 */
#include <limits.h>

#include "lamp.h"

#define WIDTH   96
#define HEIGHT  72
#define PIXELS  ((size_t)WIDTH * HEIGHT)
#define NUMBERS (3 * PIXELS)
#define RENDERS 200

/* Seeds below were used to choose the formulas of film_error.c. */
#define FIRST_SEED 1001

#define FIRST_SPP 16
#define LAST_SPP  64

/* Samples of the renders that choose the target, between the other two. */
#define TARGET_SPP   32
#define TARGET_SEEDS 4

/* Share of a pixel that replaces the mean around it if it is larger. */
#define OWN_SHARE 0.25

/* Wanted share of intervals that contain the truth. */
#define LEAST_SHARE 0.92
#define MOST_SHARE  0.98

/* Moments of a render. */
enum moment { MOMENT_FIRST, MOMENT_LAST, MOMENT_STOP, MOMENTS };

struct picture {
    struct film_error stated;
    uint64_t spp;
    bool is_stopped; /* by the limit of the error */
    float rgb[NUMBERS];
};

/* Pictures of one scene. */
struct series {
    struct scene scene;
    struct host_world host;
    struct view view;
    double target;
    struct picture pictures[MOMENTS][RENDERS];
    double sums[NUMBERS];    /* of the last pictures */
    double weights[NUMBERS]; /* of squared errors */
    double noise;            /* mean square of the reference's own error */
};

/* ---- renders ---- */

static void stop_if(bool fails, const struct error *err)
{
    if (fails)
        stress_scene_stop(err->text);
}

static struct render_progress finish(struct stress_scene *s)
{
    struct render_progress p;

    if (!render_wait(s->render, 600000))
        stress_scene_stop("a picture takes more than ten minutes");
    p = render_progress(s->render);
    stop_if(p.state != RENDER_DONE, &p.error);
    return p;
}

/* Renders with a limit of the error are adaptive, as with -e. */
static void start(struct stress_scene *s, struct series *of, uint32_t seed,
                  struct render_limits limits)
{
    struct render_job job = {.host = &of->host,
                             .crop = {0, 0, WIDTH, HEIGHT},
                             .limits = limits,
                             .is_adaptive = limits.error > 0,
                             .exposure = (float)of->view.lighting.exposure};
    struct error err;

    stop_if(!world_lend(&of->host, &of->scene, &of->view, seed, &job.world,
                        &err),
            &err);
    stop_if(!render_start(s->render, &job, &err), &err);
}

static void take(struct stress_scene *s, struct picture *to,
                 const struct render_progress *p)
{
    to->stated = p->film_error;
    to->spp = p->spp_done;
    to->is_stopped = p->stopped_by == RENDER_LIMIT_ERROR;
    film_linear(render_film(s->render), to->rgb);
}

/* Renders with one seed: to each number of samples, and to the target. */
static void render_one(struct stress_scene *s, struct series *of, int i)
{
    const uint32_t seed = FIRST_SEED + (uint32_t)i;
    struct render_progress p;

    start(s, of, seed, (struct render_limits){.spp = FIRST_SPP});
    p = finish(s);
    take(s, &of->pictures[MOMENT_FIRST][i], &p);
    render_resume(s->render, (struct render_limits){.spp = LAST_SPP});
    p = finish(s);
    take(s, &of->pictures[MOMENT_LAST][i], &p);
    start(s, of, seed,
          (struct render_limits){.spp = LAST_SPP, .error = of->target});
    p = finish(s);
    take(s, &of->pictures[MOMENT_STOP][i], &p);
}

/* Returns a target that about half of the renders reach at TARGET_SPP, because
 * their estimates are low by chance: the upper end of intervals there. */
static double find_target(struct stress_scene *s, struct series *of)
{
    double sum = 0;

    for (uint32_t i = 0; i < TARGET_SEEDS; i++) {
        start(s, of, FIRST_SEED + RENDERS + i,
              (struct render_limits){.spp = TARGET_SPP, .error = 1e-9});
        sum += finish(s).film_error.high;
    }
    return sum / TARGET_SEEDS;
}

/* ---- truth ---- */

/* Returns the mean of the 48 pixels around pixel (x, y) of a channel, fewer at
 * the edges, of `sums` of K pictures. */
static double mean_around(const double *sums, int x, int y, size_t channel)
{
    double sum = 0, count = 0;

    for (int j = y - 3; j <= y + 3; j++)
        for (int i = x - 3; i <= x + 3; i++) {
            bool is_inside = i >= 0 && i < WIDTH && j >= 0 && j < HEIGHT;

            if (!is_inside || (i == x && j == y))
                continue;
            sum += sums[3 * ((size_t)j * WIDTH + (size_t)i) + channel];
            count++;
        }
    return sum / count / RENDERS;
}

static void find_weights(struct series *of)
{
    double black = 0.1 * exp2(-of->view.lighting.exposure);

    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (size_t c = 0; c < 3; c++) {
                size_t i = 3 * ((size_t)y * WIDTH + (size_t)x) + c;
                double m = fmax(mean_around(of->sums, x, y, c),
                                OWN_SHARE * of->sums[i] / RENDERS);

                of->weights[i] = 1 / (m * m + black * black) / NUMBERS;
            }
}

/* Finds the reference, the weights and the noise of the reference. */
static void find_reference(struct series *of)
{
    memset(of->sums, 0, sizeof of->sums);
    for (int k = 0; k < RENDERS; k++)
        for (size_t i = 0; i < NUMBERS; i++)
            of->sums[i] += (double)of->pictures[MOMENT_LAST][k].rgb[i];
    find_weights(of);
    of->noise = 0;
    for (int k = 0; k < RENDERS; k++)
        for (size_t i = 0; i < NUMBERS; i++) {
            double x = (double)of->pictures[MOMENT_LAST][k].rgb[i];
            double off = x - of->sums[i] / RENDERS;

            of->noise += of->weights[i] * off * off;
        }
    of->noise /= (RENDERS - 1.0) * (RENDERS - 1.0);
}

static double true_error(const struct series *of, enum moment moment, int k)
{
    const float *x = of->pictures[moment][k].rgb;
    const float *last = of->pictures[MOMENT_LAST][k].rgb;
    double sum = 0;

    for (size_t i = 0; i < NUMBERS; i++) {
        double r = (of->sums[i] - (double)last[i]) / (RENDERS - 1);
        double off = (double)x[i] - r;

        sum += of->weights[i] * off * off;
    }
    return sqrt(fmax(sum - of->noise, 0));
}

/* ---- judgement ---- */

/* Renders of a series at one moment. */
struct coverage {
    int resolved, inside, above; /* resolved ones, and of those */
    int unresolved, lost_inside; /* the others */
    int stopped, below;          /* at the target, and truly so */
    double stated, width, truth; /* means */
    double spp;
};

static void count(struct coverage *c, const struct picture *p, double truth,
                  double target)
{
    bool is_inside = p->stated.low <= truth && truth <= p->stated.high;

    c->stated += p->stated.error / RENDERS;
    c->width += (p->stated.high - p->stated.low) / RENDERS;
    c->truth += truth / RENDERS;
    c->spp += (double)p->spp / RENDERS;
    c->stopped += p->is_stopped;
    c->below += p->is_stopped && truth <= target;
    if (p->stated.is_resolved) {
        c->resolved++;
        c->inside += is_inside;
        c->above += truth > p->stated.high;
    } else {
        c->unresolved++;
        c->lost_inside += is_inside;
    }
}

static bool is_calibrated(const struct coverage *c)
{
    double share = (double)c->inside / c->resolved;

    if (c->unresolved > RENDERS / 2)
        return true;
    return share >= LEAST_SHARE && share <= MOST_SHARE;
}

static void print_coverage(const char *name, const char *moment,
                           const struct coverage *c)
{
    char apart[80] = "";

    if (c->unresolved > 0)
        snprintf(apart, sizeof apart, "; %d unresolved, %d of them inside",
                 c->unresolved, c->lost_inside);
    row(is_calibrated(c), name,
        "%s at %.1f spp: %d of %d inside (%.1f %%, want 92 to 98), %d above; "
        "error %.2f %% +- %.2f, true %.2f %%%s",
        moment, c->spp, c->inside, c->resolved,
        c->resolved > 0 ? 100.0 * c->inside / c->resolved : 0, c->above,
        100 * c->stated, 50 * c->width, 100 * c->truth, apart);
}

static void judge(const char *name, const struct series *of)
{
    static const char *const moments[MOMENTS] = {"first", "last", "stopped"};

    for (int m = 0; m < MOMENTS; m++) {
        struct coverage c = {0};

        for (int k = 0; k < RENDERS; k++)
            count(&c, &of->pictures[m][k], true_error(of, (enum moment)m, k),
                  of->target);
        print_coverage(name, moments[m], &c);
        if (m == MOMENT_STOP)
            row(c.stopped > 0 && c.below >= LEAST_SHARE * c.stopped, name,
                "%d of %d stopped below %.3f %% truly, want 92 %%", c.below,
                c.stopped, 100 * of->target);
    }
}

/* ---- scenes ---- */

static void open_scene(struct series *of, const char *path)
{
    const struct scene_options how = {.path = path, .thread_count = 2};
    struct warnings report = {0};
    char *view_path = NULL;
    struct error err;

    view_init(&of->view);
    stop_if(!view_find(&of->view, path, NULL, &view_path, &report, &err), &err);
    view_set_size(&of->view, WIDTH, HEIGHT);
    stop_if(!scene_open(&of->scene, &of->host, &of->view, &how, &report, &err),
            &err);
    stop_if(!world_guide(&of->host, &of->scene, &of->view, &err), &err);
    warnings_free(&report);
    free(view_path);
}

static void close_scene(struct stress_scene *s, struct series *of)
{
    render_halt(s->render);
    world_free(&of->host);
    scene_free(&of->scene);
    view_free(&of->view);
}

static void check_scene(struct stress_scene *s, const char *name,
                        const char *path)
{
    struct series *of = xcalloc(1, sizeof *of);

    open_scene(of, path);
    of->target = find_target(s, of);
    for (int i = 0; i < RENDERS; i++)
        render_one(s, of, i);
    find_reference(of);
    judge(name, of);
    close_scene(s, of);
    free(of);
}

/* A mirror reflects a tiny lamp to the floor. Paths find the lamp by chance:
 * the reflected light is missing from most pixels, and huge in a few. */
static void write_caustic(struct stress_scene *s)
{
    const double side = 0.01;
    FILE *view = fopen("a.view", "w");

    if (view == NULL)
        stress_scene_stop("cannot write the view");
    fprintf(view, "eye .3 1.2 2.2\nat -.1 0 0\nfovy 40\nbackground 0 0 0\n");
    fclose(view);
    stress_scene_begin(s);
    put_floor(s);
    put_material(s, "mirror", "illum 3\nKs .9 .9 .9\nPr 0");
    put_quad(s, 0, -1, (double[]){0.2, -0.3}, (double[]){0.8, 0.3});
    put_shining(s, "lamp", 10000);
    put_quad(s, 1, 1.5, (double[]){-side, 0.5 - side},
             (double[]){side, 0.5 + side});
    stress_scene_end(s);
}

static bool is_wanted(int argc, char **argv, const char *name)
{
    return argc < 2 || strcmp(argv[1], name) == 0;
}

int main(int argc, char **argv)
{
    static const char *const files[] = {
        "cornell.obj", "materials.obj", "glass_mirror.obj", "interior.obj",
        "skylit.obj",  "lights200.obj", "principled.obj",   "water.obj",
        "globe.obj",   "bulb.obj",      "prism.obj",        "fog.obj",
        "lantern.obj", "milk.obj",      "bottles.glb",      "bubbles.glb",
        "busts.glb",   "chess.glb",     "forest.glb",       "jellyfish.glb",
        "knot.glb"};
    bool is_known = false;
    char home[PATH_MAX];
    struct stress_scene s;

    if (getcwd(home, sizeof home) == NULL)
        stress_scene_stop("no folder");
    if (!stress_scene_open(&s, false))
        return 0;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char *path = xformat("%s/scenes/%s", home, files[i]);
        char *name = xformat("%.*s", (int)strcspn(files[i], "."), files[i]);

        if (is_wanted(argc, argv, name)) {
            check_scene(&s, name, path);
            is_known = true;
        }
        free(name);
        free(path);
    }
    if (is_wanted(argc, argv, "caustic")) {
        write_caustic(&s);
        check_scene(&s, "caustic", "a.obj");
        unlink("a.view");
        is_known = true;
    }
    stress_scene_close(&s);
    if (!is_known)
        stress_scene_stop("no scene of that name");
    return rows_status();
}
