// SPDX-License-Identifier: MIT
/*
 * Numbers in text are compared with strtod() of the C library: the value and
 * the end are the same. The first eight bytes are also a double, which is
 * written and read again.
 */
#include <math.h>
#include <strings.h>

#include "base/decimal.h"
#include "fuzz.h"

static uint64_t bits_of(double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Returns whether strtod() reads more than files of scenes may have: blanks
 * before the number, hexadecimal digits, or brackets after nan. */
static int is_foreign(const char *text)
{
    const char *p = text + (*text == '-' || *text == '+');

    return strspn(text, " \t\n\v\f\r") > 0 ||
           (p[0] == '0' && (p[1] == 'x' || p[1] == 'X')) ||
           (strncasecmp(p, "nan(", 4) == 0);
}

static void check_parse(const uint8_t *data, size_t size)
{
    const char *begin = (const char *)data;
    const char *p = begin;
    char *text = strndup(begin, size);
    char *end;
    double found = 0, expected;
    int is_number = decimal_parse(&p, begin + size, &found);

    require(text != NULL, "memory");
    expected = strtod(text, &end);
    if (!is_foreign(text)) {
        require(is_number == (end != text), text);
        require(p - begin == end - text, text);
        require(!is_number || bits_of(found) == bits_of(expected) ||
                    (isnan(found) && isnan(expected)),
                text);
    }
    free(text);
}

static void check_format(const uint8_t *data)
{
    char text[DECIMAL_TEXT_BYTES];
    double value, back = 0;
    const char *p = text;

    memcpy(&value, data, sizeof value);
    if (!isfinite(value))
        return;
    decimal_format(text, value);
    require(decimal_parse(&p, text + strlen(text), &back), text);
    require(*p == '\0' && bits_of(back) == bits_of(value), text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    check_parse(data, size);
    if (size >= sizeof(double))
        check_format(data);
    return 0;
}
