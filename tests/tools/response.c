// SPDX-License-Identifier: MIT
/*
 * response.c - prints kernels/response_tables.h: responses of the channels of
 * linear Rec.709 to wavelengths
 *
 * The curves are those of the CIE 1931 observer, by the fit of Wyman, Sloan and
 * Shirley 2013, "Simple analytic approximations to the CIE XYZ color matching
 * functions", JCGT 2(2). Nodes have the distance of CIE's own tables, and
 * responses are linear between nodes.
 */
#include <math.h>
#include <stdio.h>

#define FIRST 390
#define LAST  720
#define STEP  5
#define NODES ((LAST - FIRST) / STEP + 1)

/* A Gaussian with one width below its middle and another above. */
static double lobe(double x, double middle, double below, double above)
{
    double t = (x - middle) / (x < middle ? below : above);

    return exp(-0.5 * t * t);
}

/* Sets the response of each channel. Where a linear one would be negative it is
 * 0, because sums of samples take no negative light. */
static void respond(double l, double rgb[3])
{
    double x = 1.056 * lobe(l, 599.8, 37.9, 31.0) +
               0.362 * lobe(l, 442.0, 16.0, 26.7) -
               0.065 * lobe(l, 501.1, 20.4, 26.2);
    double y =
        0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1);
    double z =
        1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8);

    rgb[0] = fmax(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, 0);
    rgb[1] = fmax(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z, 0);
    rgb[2] = fmax(0.0556434 * x - 0.2040259 * y + 1.0572252 * z, 0);
}

static void print_table(const char *what, const char *name,
                        double values[NODES][3])
{
    printf("\n/* %s */\nCONSTANT float %s[3 * RESPONSE_NODES] = {", what, name);
    for (int i = 0; i < NODES * 3; i++)
        printf("%s%.7ff,", i % 6 == 0 ? "\n    " : " ", values[i / 3][i % 3]);
    printf("\n};\n");
}

int main(void)
{
    static double responses[NODES][3], shares[NODES][3];

    for (int i = 0; i < NODES; i++)
        respond(FIRST + STEP * i, responses[i]);
    for (int c = 0; c < 3; c++) {
        double sum = 0;

        for (int i = 1; i < NODES; i++)
            sum += (responses[i - 1][c] + responses[i][c]) / 2;
        for (int i = 0; i < NODES; i++)
            responses[i][c] *= (NODES - 1) / sum;
        for (int i = 1; i < NODES; i++)
            shares[i][c] =
                shares[i - 1][c] +
                (responses[i - 1][c] + responses[i][c]) / 2 / (NODES - 1);
    }
    printf("// SPDX-License-Identifier: MIT\n"
           "/*\n"
           " * response_tables.h - responses of red, green and blue to "
           "wavelengths, for\n"
           " * dispersion.h\n"
           " *\n"
           " * Written by `make tables` (tests/tools/response.c says how).\n"
           " *\n"
           " * Units:     nanometres; a node has red, green and blue\n"
           " */\n"
           "#ifndef KERNELS_RESPONSE_TABLES_H\n"
           "#define KERNELS_RESPONSE_TABLES_H\n\n"
           "#include \"kernels/dialect.h\"\n\n"
           "// clang-format off\n"
           "#define RESPONSE_NODES %d\n"
           "#define WAVELENGTH_MIN %d.0f\n"
           "#define WAVELENGTH_STEP %d.0f /* between nodes */\n",
           NODES, FIRST, STEP);
    print_table("Responses, with a mean of 1 over the spectrum.",
                "response_nodes", responses);
    print_table("Shares of the responses up to each node.", "response_shares",
                shares);
    printf("// clang-format on\n\n#endif\n");
    return 0;
}
