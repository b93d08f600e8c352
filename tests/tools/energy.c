// SPDX-License-Identifier: MIT
/*
 * energy.c - prints kernels/energy_tables.h: albedos of GGX surfaces and sheen
 *
 * Each albedo is an integral over the square from which the kernels draw
 * visible normals: E is the mean of weights, by Gaussian quadrature in double
 * over half of the azimuth. Reflection uses bounded caps, whose weights are
 * smooth; with all visible normals the cut at the horizon costs a digit. Glass
 * needs all of them.
 */
#include <math.h>
#include <stdio.h>

#include "kernels/energy_stretched.h"

#define POINTS 128

/* Azimuths of means, in a quarter of the circle. */
#define AZIMUTHS 12

#define STRETCHED_MEANS (STRETCHED_MEAN_NODES * STRETCHED_MEAN_STRETCH_NODES)

/* Points and weights of Gaussian quadrature in [0, 1]. The points of `tail` are
 * denser near 1, where normals of the caps are far from upright; all losses of
 * narrow GGX are there. */
struct gauss {
    double x[POINTS];
    double w[POINTS];
    double tail[POINTS];
    double tail_w[POINTS];
};

/* Newton's method finds the zeros of Legendre's polynomial. */
static void gauss_init(struct gauss *g)
{
    for (int i = 0; i < POINTS; i++) {
        double z = cos(M_PI * (i + 0.75) / (POINTS + 0.5));
        double slope = 1;
        double tail;

        for (int step = 0; step < 20; step++) {
            double p = 1, before = 0;

            for (int j = 0; j < POINTS; j++) {
                double next = ((2 * j + 1) * z * p - j * before) / (j + 1);

                before = p;
                p = next;
            }
            slope = POINTS * (z * p - before) / (z * z - 1);
            z -= p / slope;
        }
        g->x[i] = 0.5 - z / 2;
        g->w[i] = 1 / ((1 - z * z) * slope * slope);
        tail = (1 - g->x[i]) * (1 - g->x[i]) * (1 - g->x[i]);
        g->tail[i] = 1 - tail * (1 - g->x[i]);
        g->tail_w[i] = g->w[i] * 4 * tail;
    }
}

static double root(double alpha, double mu)
{
    return sqrt(alpha * alpha + (1 - alpha * alpha) * mu * mu);
}

struct normal {
    double o_dot_h, z;
};

/* Returns the visible normal at (u, v) from wo = (sqrt(1 - mu^2), 0, mu). */
static struct normal visible_normal(double mu, double alpha, double bound,
                                    double u, double v)
{
    double x = sqrt(1 - mu * mu);
    double length = sqrt(alpha * alpha * x * x + mu * mu);
    double sx = alpha * x / length;
    double sz = mu / length;
    double z = (1 - v) * (1 + bound * sz) - bound * sz;
    double r = sqrt(fmax(1 - z * z, 0));
    double hx = alpha * (r * cos(M_PI * u) + sx);
    double hy = alpha * r * sin(M_PI * u);
    double hz = fmax(z + sz, 0);

    length = sqrt(hx * hx + hy * hy + hz * hz);
    if (!(length > 0))
        return (struct normal){0, 1};
    return (struct normal){(x * hx + mu * hz) / length, hz / length};
}

struct albedo {
    double one;     /* for facets of reflectance 1 */
    double schlick; /* for facets of reflectance (1 - cosine)^5 */
};

static struct albedo reflection(const struct gauss *g, double mu, double alpha)
{
    double a2 = alpha * alpha;
    double reach = 1 + sqrt(1 - mu * mu);
    double k = (1 - a2) * reach * reach / (reach * reach + a2 * mu * mu);
    struct albedo e = {0, 0};

    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < POINTS; j++) {
            struct normal h = visible_normal(mu, alpha, k, g->x[i], g->tail[j]);
            double mu_i = 2 * h.o_dot_h * h.z - mu;
            double t_o = root(alpha, mu);
            double part;

            if (!(mu_i > 0))
                continue;
            part = g->w[i] * g->tail_w[j] * mu_i * (k * mu + t_o) /
                   (mu * root(alpha, mu_i) + mu_i * t_o);
            e.one += part;
            e.schlick += part * pow(1 - fmin(h.o_dot_h, 1), 5);
        }
    return e;
}

/* The same for facets of the widths ax and ay, with the azimuth phi of wo, over
 * all of the azimuth of normals. It is periodic, so that midpoints do. */
static struct albedo stretched(const struct gauss *g, double mu, double phi,
                               double ax, double ay)
{
    double sine = sqrt(1 - mu * mu);
    double x = sine * cos(phi), y = sine * sin(phi);
    double a2 = ay * ay;
    double reach = 1 + sine;
    double k = (1 - a2) * reach * reach / (reach * reach + a2 * mu * mu);
    double t_o = sqrt(ax * ax * x * x + ay * ay * y * y + mu * mu);
    double sx = ax * x / t_o, sy = ay * y / t_o, sz = mu / t_o;
    struct albedo e = {0, 0};

    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < POINTS; j++) {
            double z = (1 - g->tail[j]) * (1 + k * sz) - k * sz;
            double r = sqrt(fmax(1 - z * z, 0));
            double turn = 2 * M_PI * (i + 0.5) / POINTS;
            double hx = ax * (r * cos(turn) + sx);
            double hy = ay * (r * sin(turn) + sy);
            double hz = fmax(z + sz, 0);
            double length = sqrt(hx * hx + hy * hy + hz * hz);
            double o_dot_h = (x * hx + y * hy + mu * hz) / length;
            double ix = 2 * o_dot_h * hx / length - x;
            double iy = 2 * o_dot_h * hy / length - y;
            double iz = 2 * o_dot_h * hz / length - mu;
            double t_i, part, c;

            if (!(iz > 0))
                continue;
            t_i = sqrt(ax * ax * ix * ix + ay * ay * iy * iy + iz * iz);
            part = g->tail_w[j] / POINTS * iz * (k * mu + t_o) /
                   (mu * t_i + iz * t_o);
            c = 1 - fmin(o_dot_h, 1);
            e.one += part;
            e.schlick += part * c * c * c * c * c;
        }
    return e;
}

/* G2 / G1. */
static double unshadowed(double alpha, double mu, double mu_i)
{
    double t_o = root(alpha, mu);

    if (!(mu_i > 0))
        return 0;
    return mu_i * (mu + t_o) / (mu * root(alpha, mu_i) + mu_i * t_o);
}

static double glass(const struct gauss *g, double mu, double alpha, double eta)
{
    double e = 0;

    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < POINTS; j++) {
            struct normal h = visible_normal(mu, alpha, 1, g->x[i], g->tail[j]);
            double c = fmin(h.o_dot_h, 1);
            double s2 = (1 - c * c) / (eta * eta);
            double f = 1, part;

            if (!(c > 0))
                continue;
            if (s2 < 1) {
                double ct = sqrt(1 - s2);
                double rs = (c - eta * ct) / (c + eta * ct);
                double rp = (eta * c - ct) / (eta * c + ct);

                f = (rs * rs + rp * rp) / 2;
            }
            part = f * unshadowed(alpha, mu, 2 * c * h.z - mu);
            if (s2 < 1)
                part += (1 - f) *
                        unshadowed(alpha, mu,
                                   mu / eta - (c / eta - sqrt(1 - s2)) * h.z);
            e += g->w[i] * g->tail_w[j] * part;
        }
    return e;
}

/* Returns where an increasing function of [0, 1] has the value y. */
static double inverse(float (*f)(float, float), float parameter, double y)
{
    double lo = 0, hi = 1;

    for (int i = 0; i < 40; i++) {
        double x = (lo + hi) / 2;

        if ((double)f((float)x, parameter) < y)
            lo = x;
        else
            hi = x;
    }
    return (lo + hi) / 2;
}

static double node(int i, int count)
{
    return (double)i / (count - 1);
}

static double alpha_at(double t)
{
    double r = (double)ROOT_SMOOTH + t * (1 - (double)ROOT_SMOOTH);

    return r * r;
}

/* At 0 this is a limit, because the tables have ratios there. */
static double mu_at(double t, double alpha)
{
    return fmax(inverse(energy_axis_mu, (float)alpha, t), 1e-7);
}

/* The fit of Estevez and Kulla 2017, "Production friendly microfacet sheen
 * BRDF", between its parameters for the roughness 0 and 1. */
static double sheen_log_lambda(double cosine, double alpha)
{
    static const double at_0[] = {25.3245, 3.32435, 0.16801, -1.27393,
                                  -4.85967};
    static const double at_1[] = {21.5473, 3.82987, 0.19823, -1.97760,
                                  -4.32054};
    double s = (1 - alpha) * (1 - alpha), p[5];

    for (int i = 0; i < 5; i++)
        p[i] = at_1[i] + s * (at_0[i] - at_1[i]);
    return p[0] / (1 + p[1] * pow(cosine, p[2])) + p[3] * cosine + p[4];
}

static double sheen_lambda(double cosine, double alpha)
{
    return exp(cosine < 0.5 ? sheen_log_lambda(cosine, alpha)
                            : 2 * sheen_log_lambda(0.5, alpha) -
                                  sheen_log_lambda(1 - cosine, alpha));
}

/* Integrates the sheen over directions: mu_i = x^2, because it is steep at 0,
 * and half of the azimuth. */
static double sheen(const struct gauss *g, double mu, double alpha)
{
    double e = 0, lambda_o = sheen_lambda(mu, alpha);
    double sine_o = sqrt(1 - mu * mu);

    for (int i = 0; i < POINTS; i++) {
        double mu_i = g->x[i] * g->x[i];
        double sine_i = sqrt(1 - mu_i * mu_i);
        double lambda = 1 + lambda_o + sheen_lambda(mu_i, alpha);

        for (int j = 0; j < POINTS; j++) {
            double phi = M_PI * g->x[j];
            double x = sine_o + sine_i * cos(phi), y = sine_i * sin(phi);
            double z = mu + mu_i;
            double sine2 = (x * x + y * y) / (x * x + y * y + z * z);
            double d = (2 + 1 / alpha) * pow(sine2, 0.5 / alpha) / (2 * M_PI);

            e += g->w[i] * 2 * g->x[i] * g->w[j] * 2 * M_PI * d /
                 (4 * mu * lambda);
        }
    }
    return e;
}

/* Inverts energy_axis_eta(), slightly inside its ends. */
static double eta_at(double t)
{
    double s = 2 * t - 1;
    double g = fmax(fmin(s * fabs(s), 1 - 1e-9), -1 + 1e-9);

    return (1 + g) / (1 - g);
}

static void print_head(const char *type, const char *name, const char *size)
{
    printf("\nCONSTANT %s %s[%s] = {", type, name, size);
}

/* Prints the gap before number i in rows of `columns`. */
static void print_gap(int i, int columns)
{
    printf("%s", i % columns == 0 ? "\n    " : " ");
}

static void print_ggx(const struct gauss *g, bool is_shift)
{
    for (int i = 0; i < GGX_ALPHA_NODES; i++)
        for (int j = 0; j < GGX_MU_NODES; j++) {
            double alpha = alpha_at(node(i, GGX_ALPHA_NODES));
            double mu = mu_at(node(j, GGX_MU_NODES), alpha);
            struct albedo e = reflection(g, mu, alpha);
            double s = mu + alpha;
            double ratio = (1 - e.one) * s * s * s / (mu * alpha * alpha);
            double shift = 1 - pow(e.schlick / e.one, 0.2) - mu;

            print_gap(i * GGX_MU_NODES + j, 6);
            printf("%.7ff,", is_shift ? shift : ratio);
        }
    printf("\n};\n");
}

/* The mean is 2 int E mu dmu, integrated over the square root of mu because E
 * is steep at 0. */
static void print_means(const struct gauss *g, bool is_schlick)
{
    for (int i = 0; i < GGX_MEAN_NODES; i++) {
        double alpha = alpha_at(node(i, GGX_MEAN_NODES));
        double sum = 0;

        for (int j = 0; j < POINTS; j++) {
            double t = g->x[j];
            double mu = t * t;
            struct albedo e = reflection(g, mu, alpha);
            double x = is_schlick ? e.schlick : (1 - e.one) / (alpha * alpha);

            sum += g->w[j] * x * 4 * mu * t;
        }
        print_gap(i, 6);
        printf("%.7ff,", sum);
    }
    printf("\n};\n");
}

static double stretch_at(int i, int count)
{
    return pow(10, 0.5 * node(i, count));
}

/* Prints the table of stretched facets, loss and shift in turn. Nodes of a
 * stretch of 1 have one azimuth. */
static void print_stretched(const struct gauss *g)
{
    const int planes = STRETCHED_ALPHA_NODES * STRETCHED_STRETCH_NODES;
    const int in_plane = STRETCHED_WIDTH_NODES * STRETCHED_MU_NODES;

    for (int i = 0; i < planes * in_plane; i++) {
        double alpha = alpha_at(node(i / in_plane / STRETCHED_STRETCH_NODES,
                                     STRETCHED_ALPHA_NODES));
        double s = stretch_at(i / in_plane % STRETCHED_STRETCH_NODES,
                              STRETCHED_STRETCH_NODES);
        double t =
            node(i % in_plane / STRETCHED_MU_NODES, STRETCHED_WIDTH_NODES);
        double width = pow(s, 2 * t - 1);
        double share =
            s > 1 ? (width * width - 1 / s / s) / (s * s - 1 / s / s) : t;
        double mu = mu_at(node(i % STRETCHED_MU_NODES, STRETCHED_MU_NODES),
                          alpha * width);
        double phi = acos(sqrt(fmin(fmax(share, 0), 1)));
        struct albedo e = stretched(g, mu, phi, alpha * s, alpha / s);
        double scale =
            (double)stretched_loss_scale((float)mu, (float)alpha, (float)s);
        double shift = 1 - pow(e.schlick / e.one, 0.2) - mu;

        print_gap(2 * i, 12);
        printf("%.0f, %.0f,", (1 - e.one) / scale / (double)STRETCHED_LOSS_UNIT,
               (shift + (double)STRETCHED_SHIFT_MIN) /
                   (double)STRETCHED_SHIFT_UNIT);
    }
    printf("\n};\n");
}

/* Computes the means of print_means() for stretched facets, also over the
 * azimuth. */
static void find_stretched_means(const struct gauss *g, struct albedo *means)
{
    for (int i = 0; i < STRETCHED_MEANS; i++) {
        double alpha = alpha_at(
            node(i / STRETCHED_MEAN_STRETCH_NODES, STRETCHED_MEAN_NODES));
        double s = stretch_at(i % STRETCHED_MEAN_STRETCH_NODES,
                              STRETCHED_MEAN_STRETCH_NODES);
        double square = alpha * alpha * (s * s + 1 / s / s) / 2;

        for (int j = 0; j < POINTS * AZIMUTHS; j++) {
            double t = g->x[j / AZIMUTHS];
            double phi = M_PI / 2 * (j % AZIMUTHS + 0.5) / AZIMUTHS;
            double weight = g->w[j / AZIMUTHS] / AZIMUTHS * 4 * t * t * t;
            struct albedo e = stretched(g, t * t, phi, alpha * s, alpha / s);

            means[i].one += weight * (1 - e.one) / square;
            means[i].schlick += weight * e.schlick;
        }
    }
}

static void print_stretched_means(const struct albedo *means, bool is_schlick)
{
    for (int i = 0; i < STRETCHED_MEANS; i++) {
        print_gap(i, 6);
        printf("%.7ff,", is_schlick ? means[i].schlick : means[i].one);
    }
    printf("\n};\n");
}

static void print_glass(const struct gauss *g)
{
    for (int i = 0; i < GLASS_ETA_NODES; i++)
        for (int j = 0; j < GLASS_ALPHA_NODES; j++)
            for (int k = 0; k < GLASS_MU_NODES; k++) {
                double alpha = alpha_at(node(j, GLASS_ALPHA_NODES));
                double mu = mu_at(node(k, GLASS_MU_NODES), alpha);
                double eta = eta_at(node(i, GLASS_ETA_NODES));
                int row = i * GLASS_ALPHA_NODES + j;

                print_gap(row * GLASS_MU_NODES + k, 12);
                printf("%.0f,", 65535 * fmin(glass(g, mu, alpha, eta), 1));
            }
    printf("\n};\n");
}

/* Grazing directions below a cosine of 1e-3 have the albedo there. */
static void print_sheen(const struct gauss *g)
{
    for (int i = 0; i < SHEEN_ALPHA_NODES; i++)
        for (int j = 0; j < SHEEN_MU_NODES; j++) {
            double t = node(i, SHEEN_ALPHA_NODES);
            double alpha =
                (double)SHEEN_ALPHA_MIN + t * (1 - (double)SHEEN_ALPHA_MIN);
            double root = node(j, SHEEN_MU_NODES);
            double mu = fmax(root * root, 1e-3);

            print_gap(i * SHEEN_MU_NODES + j, 6);
            printf("%.7ff,", fmin(sheen(g, mu, alpha), 1));
        }
    printf("\n};\n");
}

#define STRETCHED_SIZE                                       \
    "2 * STRETCHED_ALPHA_NODES * STRETCHED_STRETCH_NODES * " \
    "STRETCHED_WIDTH_NODES * STRETCHED_MU_NODES"

int main(void)
{
    static struct gauss g;
    static struct albedo means[STRETCHED_MEANS];

    gauss_init(&g);
    printf("// SPDX-License-Identifier: MIT\n"
           "/*\n"
           " * energy_tables.h - albedos of surfaces, for energy.h\n"
           " *\n"
           " * Written by `make tables` (tests/tools/energy.c says how); "
           "tests/unit/\n"
           " * test_energy.c compares with another quadrature. Long because "
           "of its data.\n"
           " *\n"
           " * Units:     nodes are uniform along the axes of energy.h, the "
           "last one (mu)\n"
           " *            running fastest\n"
           " */\n"
           "#ifndef KERNELS_ENERGY_TABLES_H\n"
           "#define KERNELS_ENERGY_TABLES_H\n\n"
           "#include \"kernels/dialect.h\"\n\n"
           "// clang-format off\n");
    printf("#define GGX_ALPHA_NODES %d\n#define GGX_MU_NODES %d\n"
           "#define GGX_MEAN_NODES %d\n#define GLASS_ETA_NODES %d\n"
           "#define GLASS_ALPHA_NODES %d\n#define GLASS_MU_NODES %d\n"
           "#define SHEEN_ALPHA_NODES %d\n#define SHEEN_MU_NODES %d\n"
           "#define STRETCHED_ALPHA_NODES %d\n"
           "#define STRETCHED_STRETCH_NODES %d\n"
           "#define STRETCHED_WIDTH_NODES %d\n#define STRETCHED_MU_NODES %d\n"
           "#define STRETCHED_MEAN_NODES %d\n"
           "#define STRETCHED_MEAN_STRETCH_NODES %d\n"
           "#define STRETCHED_LOSS_UNIT %.6ff\n"
           "#define STRETCHED_SHIFT_UNIT %.8ff\n"
           "#define STRETCHED_SHIFT_MIN %.2ff\n",
           GGX_ALPHA_NODES, GGX_MU_NODES, GGX_MEAN_NODES, GLASS_ETA_NODES,
           GLASS_ALPHA_NODES, GLASS_MU_NODES, SHEEN_ALPHA_NODES, SHEEN_MU_NODES,
           STRETCHED_ALPHA_NODES, STRETCHED_STRETCH_NODES,
           STRETCHED_WIDTH_NODES, STRETCHED_MU_NODES, STRETCHED_MEAN_NODES,
           STRETCHED_MEAN_STRETCH_NODES, (double)STRETCHED_LOSS_UNIT,
           (double)STRETCHED_SHIFT_UNIT, (double)STRETCHED_SHIFT_MIN);
    printf("\n/* 1 - E over ggx_loss_scale(). */");
    print_head("float", "ggx_losses", "GGX_ALPHA_NODES * GGX_MU_NODES");
    print_ggx(&g, false);
    printf("\n/* (1 - mu - shift)^5 is the Schlick part of E. */");
    print_head("float", "ggx_shifts", "GGX_ALPHA_NODES * GGX_MU_NODES");
    print_ggx(&g, true);
    printf("\n/* 2 int (1 - E) mu dmu over alpha^2, and of the Schlick part. "
           "*/");
    print_head("float", "ggx_mean_losses", "GGX_MEAN_NODES");
    print_means(&g, false);
    print_head("float", "ggx_mean_schlicks", "GGX_MEAN_NODES");
    print_means(&g, true);
    printf("\n/* 65535 E of reflection and transmission. */");
    print_head("uint16_t", "glass_albedos",
               "GLASS_ETA_NODES * GLASS_ALPHA_NODES * GLASS_MU_NODES");
    print_glass(&g);
    printf("\n/* E of white sheen. */");
    print_head("float", "sheen_albedos", "SHEEN_ALPHA_NODES * SHEEN_MU_NODES");
    print_sheen(&g);
    printf("\n/* Of stretched facets, in turn: 1 - E over "
           "stretched_loss_scale(), shifts as above. */");
    print_head("uint16_t", "stretched_albedos", STRETCHED_SIZE);
    print_stretched(&g);
    find_stretched_means(&g, means);
    print_head("float", "stretched_mean_losses",
               "STRETCHED_MEAN_NODES * STRETCHED_MEAN_STRETCH_NODES");
    print_stretched_means(means, false);
    print_head("float", "stretched_mean_schlicks",
               "STRETCHED_MEAN_NODES * STRETCHED_MEAN_STRETCH_NODES");
    print_stretched_means(means, true);
    printf("// clang-format on\n\n#endif\n");
    return 0;
}
