// SPDX-License-Identifier: MIT
#include "render/error_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Errors beyond these, in per cent, are not told apart. */
#define PERCENT_MAX  9999
#define DECIMALS_MAX 6

/* What follows an unresolved error */
#define IN_FEW_PIXELS ", mostly in few pixels"

static int decimals_of(double percent)
{
    double bound = 9.95;
    int decimals = 0;

    while (percent < bound && decimals < DECIMALS_MAX) {
        bound /= 10;
        decimals++;
    }
    return decimals;
}

/* Formats the number without its unit. */
static void format_percent(char text[ERROR_TEXT_BYTES], double error)
{
    double percent = 100 * error;

    if (!(percent <= PERCENT_MAX))
        snprintf(text, ERROR_TEXT_BYTES, "over %d", PERCENT_MAX);
    else
        snprintf(text, ERROR_TEXT_BYTES, "%.*f",
                 percent > 0 ? decimals_of(percent) : 0, percent);
}

void error_text_percent(char text[ERROR_TEXT_BYTES], double error)
{
    char number[ERROR_TEXT_BYTES];

    format_percent(number, error);
    snprintf(text, ERROR_TEXT_BYTES, "%.40s %%", number);
}

void error_text_interval(char text[ERROR_TEXT_BYTES],
                         const struct film_error *e)
{
    char middle[ERROR_TEXT_BYTES], low[ERROR_TEXT_BYTES],
        high[ERROR_TEXT_BYTES];

    if (!e->is_known) {
        snprintf(text, ERROR_TEXT_BYTES, "unknown");
        return;
    }
    format_percent(middle, e->error);
    format_percent(low, e->low);
    format_percent(high, e->high);
    snprintf(text, ERROR_TEXT_BYTES, "%.10s %% (%.10s to %.10s %%)%s", middle,
             low, high, e->is_resolved ? "" : IN_FEW_PIXELS);
}

void error_text_noise(char text[ERROR_TEXT_BYTES], const struct film_error *e)
{
    char number[ERROR_TEXT_BYTES];

    error_text_percent(number, e->error);
    snprintf(text, ERROR_TEXT_BYTES, "noise %.20s%s",
             e->is_known ? number : "unknown",
             e->is_known && !e->is_resolved ? IN_FEW_PIXELS : "");
}

bool error_text_faults(char text[ERROR_FAULTS_BYTES], uint64_t non_finite,
                       uint64_t saturated)
{
    if (non_finite > 0)
        snprintf(text, ERROR_FAULTS_BYTES,
                 "%" PRIu64 " samples were not finite and count as black",
                 non_finite);
    else if (saturated > 0)
        snprintf(text, ERROR_FAULTS_BYTES,
                 "%" PRIu64
                 " samples were too bright: sums above 2^63 are cut, "
                 "and the picture is too dark there",
                 saturated);
    return non_finite > 0 || saturated > 0;
}

double error_text_target(double error)
{
    double target = 0.1;

    for (int i = 0; target > error / 2 && i < 3 * DECIMALS_MAX; i++)
        target /= i % 3 == 1 ? 2.5 : 2;
    return target;
}
