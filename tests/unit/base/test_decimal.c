// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "tests/unit/check.h"
#include "tests/unit/locales.h"

static uint64_t random_state = 1;

static uint64_t next_random(void)
{
    random_state = random_state * UINT64_C(6364136223846793005) +
                   UINT64_C(1442695040888963407);
    uint64_t x = random_state ^ (random_state >> 31);
    return x * UINT64_C(0x9e3779b97f4a7c15);
}

static uint64_t bits_of(double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Compares with strtod() of the C library in the C locale. */
static void agrees_with_strtod(const char *text)
{
    const char *p = text;
    char *expected_end;
    double expected = strtod(text, &expected_end);
    double found = 0;

    bool same;

    check_or_say(decimal_parse(&p, text + strlen(text), &found), text);
    same = p == expected_end && bits_of(found) == bits_of(expected);
    if (!same)
        print_error("'%.40s': found %.17g, expected %.17g\n", text, found,
                    expected);
    assert_true(same);
}

static void all_forms_are_read_as_by_strtod(void **state)
{
    static const char *const texts[] = {
        "0",
        "-0",
        "+1",
        ".5",
        "5.",
        "-.5",
        "00012",
        "0.000",
        "1e5",
        "1E+05",
        "1e-05",
        "1e400",
        "-1e400",
        "1e-400",
        "inf",
        "-inf",
        "+Infinity",
        "INF",
        "1e",
        "1e+",
        "1.5e-",
        "1x",
        "1.2.3",
        "1,5",
        "infinit",
        "4294967295",
        "18446744073709551615",
        "99999999999999999999",
        "9007199254740993",
        "9007199254740992",
        "9007199254740991",
        "9007199254740993e1",
        "90071992547409930e-1",
        "1e22",
        "1e23",
        "8.5e22",
        "123456789012345678e-19",
        "9999999999999999999e-19",
        "9999999999999999999e19",
        "4.9e-324",
        "2.4e-324",
        "2.5e-324",
        "1.7976931348623157e308",
        "1.7976931348623159e308",
        "2.2250738585072011e-308",
        "0.1",
        "1e99999999999999999999999",
        "1e-99999999999999999999999",
        "0e99999999999999999999999",
    };

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        agrees_with_strtod(texts[i]);
}

static void nan_is_read_in_any_case(void **state)
{
    static const char *const texts[] = {"nan", "NaN", "-nan", "+NAN"};

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        const char *p = texts[i];
        double value = 0;
        assert_true(decimal_parse(&p, p + strlen(p), &value));
        assert_true(isnan(value));
        assert_int_equal(*p, 0);
    }
}

static void what_is_no_number_is_refused(void **state)
{
    static const char *const texts[] = {"",   "+",  "-",   ".",   "+.",
                                        "e5", "x1", "--1", "+-1", " 1",
                                        "in", "na", ".e5"};

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        const char *p = texts[i];
        double value = 7;

        check_or_say(!decimal_parse(&p, p + strlen(p), &value), texts[i]);
        assert_ptr_equal(p, texts[i]);
        assert_true(value == 7);
    }
}

/* The parser reads no byte at or behind the end. */
static void parser_stops_at_the_end(void **state)
{
    static const char text[] = "12.5e12nan";

    (void)state;
    for (int length = 1; length <= 7; length++) {
        static const double expected[] = {1, 12, 12, 12.5, 12.5, 125, 12.5e12};
        /* Exact size, so that a sanitizer finds reads behind it. */
        char *copy = malloc((size_t)length);
        double value = 0;

        assert_non_null(copy);
        memcpy(copy, text, (size_t)length);
        const char *p = copy;
        assert_true(decimal_parse(&p, copy + length, &value));
        assert_true(value == expected[length - 1]);
        free(copy);
    }
}

static void random_numbers_are_read_as_by_strtod(void **state)
{
    (void)state;
    for (int i = 0; i < (check_is_thorough() ? 200000 : 40000); i++) {
        char text[64];
        uint64_t bits = next_random();
        double value;

        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            snprintf(text, sizeof text, "%.17g", value);
            agrees_with_strtod(text);
        }
        value = ldexp((double)(next_random() >> 11), -60) - 0.004;
        snprintf(text, sizeof text, "%.*g", 1 + i % 17, value);
        agrees_with_strtod(text);
        snprintf(text, sizeof text, "%.*f", i % 22, value * 1000);
        agrees_with_strtod(text);
        snprintf(text, sizeof text, "%" PRIu64 "e%d", next_random() >> (i % 40),
                 (int)(next_random() >> 32) % 30);
        agrees_with_strtod(text);
    }
}

/* Tests exact half-way points and their neighbours, at full length. */
static void halfway_points_round_as_by_strtod(void **state)
{
    char text[2000];

    (void)state;
    for (int i = 0; i < 300; i++) {
        uint64_t mantissa = (next_random() >> 11) | UINT64_C(1) << 52;
        int exponent = -1070 + i * 7 % 1000;
        /* A 54-bit number is exact in long double, and so is its decimal
         * form. */
        long double half = ldexpl((long double)mantissa * 2 + 1, exponent);
        int length = snprintf(text, sizeof text - 2, "%.1100Lf", half);
        assert_in_range(length, 1, (int)sizeof text - 3);
        agrees_with_strtod(text);
        memcpy(text + length, "1", 2);
        agrees_with_strtod(text);
    }
}

static void a_million_digits_are_read_as_by_strtod(void **state)
{
    size_t length = 1000000;
    char *text = malloc(length + 32);

    (void)state;
    assert_non_null(text);
    memset(text, '7', length);
    strcpy(text + length, "e-999990");
    agrees_with_strtod(text);
    memset(text, '0', length);
    text[1] = '.';
    strcpy(text + length, "25e1000000");
    agrees_with_strtod(text);
    free(text);
}

static void locale_with_decimal_comma_changes_nothing(void **state)
{
    const char *p = "0.12345678901234567890123";
    double value = 0;

    (void)state;
    if (!set_language(LC_NUMERIC, "de_DE"))
        skip();
    bool ok = decimal_parse(&p, p + strlen(p), &value);
    char text[DECIMAL_TEXT_BYTES];
    decimal_format(text, 2.5);
    setlocale(LC_NUMERIC, "C");
    assert_true(ok);
    assert_true(value == 0.12345678901234567890123);
    assert_string_equal(text, "2.5");
}

/* In Turkish the small letter of I is not i. */
static void turkish_locale_changes_nothing(void **state)
{
    static const char text[] = "INFINITY";
    const char *p = text;
    double value = 0;
    bool ok;

    (void)state;
    if (!set_language(LC_CTYPE, "tr_TR"))
        skip();
    ok = decimal_parse(&p, text + strlen(text), &value);
    setlocale(LC_CTYPE, "C");
    assert_true(ok && value == INFINITY && *p == '\0');
}

static void formatted_doubles_are_read_back_exactly(void **state)
{
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0, "0"},
                 {1, "1"},
                 {-0.5, "-0.5"},
                 {0.1, "0.1"},
                 {278, "278"},
                 {39.3077, "39.3077"},
                 {1e100, "1e+100"},
                 {1e-7, "1e-07"},
                 {1234567, "1234567"},
                 {0.1 + 0.2, "0.30000000000000004"}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[DECIMAL_TEXT_BYTES];
        decimal_format(text, cases[i].value);
        assert_string_equal(text, cases[i].text);
    }
    for (int i = 0; i < (check_is_thorough() ? 100000 : 40000); i++) {
        char text[DECIMAL_TEXT_BYTES];
        uint64_t bits = next_random();
        double value;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        decimal_format(text, value);
        assert_true(strtod(text, NULL) == value);
    }
}

/* No shorter text gives the same float. The text of a double gives the same
 * double. */
static void shortest_text_gives_the_same_number(void **state)
{
    static const struct {
        double value;
        const char *as_float, *as_double;
    } cases[] = {
        {0.5, "0.5", "0.5"},
        {0.1, "0.1", "0.1"},
        {0.1f, "0.1", "0.10000000149011612"},
        {0.1 + 0.2, "0.3", "0.30000000000000004"},
        {1.0 / 3, "0.33333334", "0.3333333333333333"},
        {278.00000000000006, "278", "278.00000000000006"},
        {16777217, "16777216", "16777217"},
        {-0.0, "-0", "-0"},
    };

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[DECIMAL_TEXT_BYTES];

        decimal_format_float(text, (float)cases[i].value);
        assert_string_equal(text, cases[i].as_float);
        decimal_format(text, cases[i].value);
        assert_string_equal(text, cases[i].as_double);
    }
    assert_true(decimal_shortened(1e-60) == 1e-60);
    assert_true(decimal_shortened(1e60) == 1e60);
    assert_true(decimal_shortened(0) == 0);
    assert_true(decimal_shortened(0.1 + 0.2) == 0.3);
    for (int i = 0; i < (check_is_thorough() ? 100000 : 40000); i++) {
        uint32_t bits = (uint32_t)(next_random() >> 32);
        char text[DECIMAL_TEXT_BYTES];
        float value;

        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        decimal_format_float(text, value);
        assert_true(strtof(text, NULL) == value);
        assert_true((float)decimal_shortened((double)value) == value);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_forms_are_read_as_by_strtod),
        cmocka_unit_test(nan_is_read_in_any_case),
        cmocka_unit_test(what_is_no_number_is_refused),
        cmocka_unit_test(parser_stops_at_the_end),
        cmocka_unit_test(shortest_text_gives_the_same_number),
        cmocka_unit_test(random_numbers_are_read_as_by_strtod),
        cmocka_unit_test(halfway_points_round_as_by_strtod),
        cmocka_unit_test(a_million_digits_are_read_as_by_strtod),
        cmocka_unit_test(locale_with_decimal_comma_changes_nothing),
        cmocka_unit_test(turkish_locale_changes_nothing),
        cmocka_unit_test(formatted_doubles_are_read_back_exactly),
    };

    return cmocka_run_group_tests_name("number", tests, make_folder,
                                       remove_folder);
}
