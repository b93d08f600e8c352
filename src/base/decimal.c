// SPDX-License-Identifier: MIT
#include "base/decimal.h"

#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Decimal digits that always fit in a uint64_t. */
#define DIGITS_MAX 19

/* Digits passed to strtod(). Half-way points between doubles have at most 768
 * significant digits; later digits only tell whether the number lies above one.
 */
#define DIGITS_THAT_COUNT 800

/* Limit for exponents: beyond any double, and far from overflow in sums. */
#define EXPONENT_MAX 1000000000000LL

__extension__ typedef unsigned __int128 wide_uint;

/* Parts of a parsed number. Its value is digits * 10^exponent. */
struct decimal {
    const char *digits; /* from the first nonzero digit; may contain a '.' */
    const char *digits_end;
    uint64_t mantissa; /* valid if digit_count <= DIGITS_MAX */
    int64_t digit_count;
    int64_t exponent;
    bool is_negative;
};

static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                              1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                              1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static const uint64_t integer_tens[] = {
    1u,
    10u,
    100u,
    1000u,
    10000u,
    100000u,
    1000000u,
    10000000u,
    100000000u,
    1000000000u,
    10000000000u,
    100000000000u,
    1000000000000u,
    10000000000000u,
    100000000000000u,
    1000000000000000u,
    10000000000000000u,
    100000000000000000u,
    1000000000000000000u,
    10000000000000000000u,
};

static bool is_digit(const char *p, const char *end)
{
    return p < end && (unsigned char)(*p - '0') <= 9;
}

/* Returns true if the text begins with the word in any letter case. The word is
 * in lower-case ASCII; tolower() would depend on the locale. */
static bool begins_with(const char *p, const char *end, const char *word)
{
    for (; *word != '\0'; p++, word++)
        if (p == end || (*p | 0x20) != *word)
            return false;
    return true;
}

/* Reads "nan", "inf" or "infinity" in any letter case. */
static bool parse_word(const char **p, const char *end, double *value)
{
    static const struct {
        const char *word;
        double value;
    } words[] = {{"infinity", INFINITY}, {"inf", INFINITY}, {"nan", NAN}};

    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (begins_with(*p, end, words[i].word)) {
            *p += strlen(words[i].word);
            *value = words[i].value;
            return true;
        }
    }
    return false;
}

/* Reads an exponent such as "e-12" and moves *p behind it. Without digits it
 * returns 0 and leaves *p. */
static int64_t parse_exponent(const char **p, const char *end)
{
    const char *q = *p;
    int64_t exponent = 0;
    bool is_negative = false;

    if (q >= end || (*q != 'e' && *q != 'E'))
        return 0;
    q++;
    if (q < end && (*q == '+' || *q == '-'))
        is_negative = *q++ == '-';
    if (!is_digit(q, end))
        return 0;
    for (; is_digit(q, end); q++) {
        if (exponent < EXPONENT_MAX)
            exponent = exponent * 10 + (*q - '0');
    }
    *p = q;
    return is_negative ? -exponent : exponent;
}

/* Reads the digits and the decimal point. Leading zeros are not counted. The
 * mantissa wraps around beyond DIGITS_MAX digits and is not used then. */
static bool parse_digits(const char **p, const char *end, struct decimal *d)
{
    const char *q = *p;
    const char *start = q;
    const char *point = NULL;
    uint64_t mantissa = 0;
    int64_t length;

    while (q < end && *q == '0')
        q++;
    d->digits = q;
    for (; is_digit(q, end); q++)
        mantissa = mantissa * 10 + (uint64_t)(*q - '0');
    length = q - start;
    d->digit_count = q - d->digits;
    if (q < end && *q == '.') {
        point = ++q;
        if (d->digit_count == 0) {
            while (q < end && *q == '0')
                q++;
            d->digits = q;
        }
        const char *first = q;
        for (; is_digit(q, end); q++)
            mantissa = mantissa * 10 + (uint64_t)(*q - '0');
        d->digit_count += q - first;
        length += q - point;
    }
    if (length == 0)
        return false;
    d->digits_end = q;
    d->mantissa = mantissa;
    d->exponent = point ? point - q : 0;
    *p = q;
    return true;
}

/* Converts with one exact operation and one rounding, so the result is
 * correctly rounded. Up to 2^53 and 10^22 both operands are doubles (Clinger
 * 1990). Above that, 128-bit integers hold the product, or a quotient of at
 * least 63 bits whose last bit also stands for the remainder. */
static bool convert_fast(const struct decimal *d, double *value)
{
    int64_t e = d->exponent;

    if (d->digit_count > DIGITS_MAX || e < -22 || e > 22)
        return false;
    if (d->mantissa <= UINT64_C(1) << 53) {
        *value = e < 0 ? (double)d->mantissa / tens[-e]
                       : (double)d->mantissa * tens[e];
        return true;
    }
    if (e < -19 || e > 19)
        return false;
    if (e >= 0) {
        *value = (double)((wide_uint)d->mantissa * integer_tens[e]);
        return true;
    }

    int shift = __builtin_clzll(d->mantissa);
    uint64_t divisor = integer_tens[-e];
    wide_uint dividend = (wide_uint)(d->mantissa << shift) << 64;
    wide_uint quotient = dividend / divisor;
    if (quotient * divisor != dividend)
        quotient |= 1;
    *value = ldexp((double)quotient, -64 - shift);
    return true;
}

/* Converts with strtod(). The text has no decimal point, so every locale reads
 * it alike. */
static double convert_slow(const struct decimal *d)
{
    char text[DIGITS_THAT_COUNT + 32];
    int64_t kept = 0;
    int64_t exponent = d->exponent;
    bool has_more = false;

    for (const char *p = d->digits; p < d->digits_end; p++) {
        if (*p == '.')
            continue;
        if (kept < DIGITS_THAT_COUNT)
            text[kept++] = *p;
        else
            has_more |= *p != '0';
    }
    exponent += d->digit_count - kept;
    if (has_more) {
        text[kept++] = '1';
        exponent--;
    }
    if (exponent > EXPONENT_MAX)
        exponent = EXPONENT_MAX;
    if (exponent < -EXPONENT_MAX)
        exponent = -EXPONENT_MAX;
    snprintf(text + kept, sizeof text - (size_t)kept, "e%" PRId64, exponent);
    return strtod(text, NULL);
}

bool decimal_parse(const char **p, const char *end, double *value)
{
    const char *q = *p;
    struct decimal d = {.is_negative = false};
    double result = 0;

    if (q < end && (*q == '+' || *q == '-'))
        d.is_negative = *q++ == '-';
    if (parse_digits(&q, end, &d)) {
        if (q < end && (*q == 'e' || *q == 'E'))
            d.exponent += parse_exponent(&q, end);
        if (d.digit_count > 0 && !convert_fast(&d, &result))
            result = convert_slow(&d);
    } else if (!parse_word(&q, end, &result)) {
        return false;
    }
    *p = q;
    *value = d.is_negative ? -result : result;
    return true;
}

/* Writes the value with this number of digits, and returns the value that
 * reading the text back gives. */
static double format_digits(char text[DECIMAL_TEXT_BYTES], double value,
                            int digits)
{
    const char *p = text;
    double back = 0;

    snprintf(text, DECIMAL_TEXT_BYTES, "%.*g", digits, value);
    char *comma = strchr(text, ','); /* decimal point of some locales */
    if (comma)
        *comma = '.';
    decimal_parse(&p, text + strlen(text), &back);
    return back;
}

/* Tries six digits first, and more until the text reads back exactly. Trailing
 * zeros are left out. */
void decimal_format(char text[DECIMAL_TEXT_BYTES], double value)
{
    for (int digits = 6; digits <= 17; digits++) {
        if (format_digits(text, value, digits) == value)
            return;
    }
}

void decimal_format_float(char text[DECIMAL_TEXT_BYTES], float value)
{
    for (int digits = 6; digits <= 9; digits++) {
        if ((float)format_digits(text, (double)value, digits) == value)
            return;
    }
}

double decimal_shortened(double value)
{
    char text[DECIMAL_TEXT_BYTES];
    const char *p = text;
    double shortened = value;

    if (!(fabs(value) >= (double)FLT_MIN && fabs(value) <= (double)FLT_MAX))
        return value;
    decimal_format_float(text, (float)value);
    decimal_parse(&p, text + strlen(text), &shortened);
    return shortened;
}

/* ---- whole numbers ---- */

bool digits_parse(const char **p, int base, uint64_t most, uint64_t *value)
{
    const char *digits = base == 16 ? "0123456789abcdef" : "0123456789";
    char *end;

    if (**p == '\0' || strchr(digits, **p) == NULL)
        return false; /* strtoull() accepts blanks and signs */
    errno = 0;
    *value = strtoull(*p, &end, base);
    *p = end;
    return errno == 0 && *value <= most;
}
