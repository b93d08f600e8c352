// SPDX-License-Identifier: MIT
#include "terminal/glyphs.h"

#include <assert.h>

/* Quadrants by mask, U+2580..259F. The first four masks also index half blocks,
 * where bit 1 means the lower half. */
static const uint32_t halves[4] = {' ', CELL_UPPER, CELL_LOWER, CELL_FULL};

static const uint32_t quadrants[16] = {' ',        0x2598, 0x259d, CELL_UPPER,
                                       0x2596,     0x258c, 0x259e, 0x259b,
                                       0x2597,     0x259a, 0x2590, 0x259c,
                                       CELL_LOWER, 0x2599, 0x259f, CELL_FULL};

/* Sextants from U+1FB00 on, by mask. Unicode omits those that existed before:
 * none, left half, right half and all. */
#define SEXTANT_FIRST 0x1fb00u
#define SEXTANT_LAST  0x1fb3bu
#define LEFT_HALF     0x15u
#define RIGHT_HALF    0x2au
#define SEXTANT_ALL   0x3fu

/* Braille code points: U+2800 plus these bits for each dot. The standard
 * numbers the first three rows by columns, then the fourth. */
#define BRAILLE_FIRST 0x2800u
#define BRAILLE_LAST  0x28ffu
static const uint8_t braille_dots[8] = {1, 8, 2, 16, 4, 32, 64, 128};

static const struct {
    struct glyph_grid grid;
    const char *name;
} kinds[GLYPHS_COUNT] = {
    [GLYPHS_HALF] = {{1, 2}, "half blocks"},
    [GLYPHS_UPPER] = {{1, 2}, "upper half blocks"},
    [GLYPHS_LOWER] = {{1, 2}, "lower half blocks"},
    [GLYPHS_QUADRANT] = {{2, 2}, "quadrants"},
    [GLYPHS_SEXTANT] = {{2, 3}, "sextants"},
    [GLYPHS_BRAILLE] = {{2, 4}, "braille"},
    [GLYPHS_SPACE] = {{1, 1}, "blanks"},
    [GLYPHS_ASCII] = {{1, 1}, "letters"},
};

struct glyph_grid glyphs_grid(enum glyphs glyphs)
{
    return kinds[glyphs].grid;
}

const char *glyphs_name(enum glyphs glyphs)
{
    return kinds[glyphs].name;
}

bool glyphs_are_solid(enum glyphs glyphs)
{
    return glyphs == GLYPHS_HALF || glyphs == GLYPHS_QUADRANT ||
           glyphs == GLYPHS_SEXTANT;
}

static uint32_t sextant(unsigned mask)
{
    switch (mask) {
    case 0: return ' ';
    case LEFT_HALF: return quadrants[5];
    case RIGHT_HALF: return quadrants[10];
    case SEXTANT_ALL: return CELL_FULL;
    default: break;
    }
    return SEXTANT_FIRST + mask - 1 - (mask > LEFT_HALF) - (mask > RIGHT_HALF);
}

static uint32_t braille(unsigned mask)
{
    uint32_t glyph = BRAILLE_FIRST;

    for (int i = 0; i < 8; i++)
        glyph += mask >> i & 1 ? braille_dots[i] : 0;
    return mask ? glyph : ' ';
}

uint32_t glyphs_of_mask(enum glyphs glyphs, unsigned mask)
{
    switch (glyphs) {
    case GLYPHS_QUADRANT: return quadrants[mask];
    case GLYPHS_SEXTANT: return sextant(mask);
    case GLYPHS_BRAILLE: return braille(mask);
    case GLYPHS_SPACE:
    case GLYPHS_ASCII: return ' ';
    default: return halves[mask];
    }
}

/* Finds a glyph among the first `count` of a table; its index is the mask. */
static bool find(const uint32_t *table, unsigned count, uint32_t glyph,
                 unsigned *mask)
{
    for (*mask = 0; *mask < count; ++*mask) {
        if (table[*mask] == glyph)
            return true;
    }
    return false;
}

static bool sextant_mask(uint32_t glyph, unsigned *mask)
{
    if (glyph < SEXTANT_FIRST || glyph > SEXTANT_LAST) {
        static const uint32_t others[4] = {' ', 0x258c, 0x2590, CELL_FULL};

        if (!find(others, 4, glyph, mask))
            return false;
        *mask *= LEFT_HALF; /* times 2: right half, times 3: all */
        return true;
    }
    *mask = glyph - SEXTANT_FIRST + 1;
    *mask += *mask >= LEFT_HALF;
    *mask += *mask >= RIGHT_HALF;
    return true;
}

static bool braille_mask(uint32_t glyph, unsigned *mask)
{
    *mask = 0;
    if (glyph == ' ')
        return true;
    for (unsigned i = 0; i < 8; i++)
        *mask |= glyph & braille_dots[i] ? 1u << i : 0;
    return glyph >= BRAILLE_FIRST && glyph <= BRAILLE_LAST;
}

bool glyphs_mask(enum glyphs glyphs, uint32_t glyph, unsigned *mask)
{
    switch (glyphs) {
    case GLYPHS_QUADRANT: return find(quadrants, 16, glyph, mask);
    case GLYPHS_SEXTANT: return sextant_mask(glyph, mask);
    case GLYPHS_BRAILLE: return braille_mask(glyph, mask);
    case GLYPHS_SPACE:
    case GLYPHS_ASCII: return find(halves, 1, glyph, mask);
    default: return find(halves, 4, glyph, mask);
    }
}

int glyph_utf8(uint32_t glyph, char bytes[4])
{
    int more = glyph < 0x80 ? 0 : glyph < 0x800 ? 1 : glyph < 0x10000 ? 2 : 3;

    assert(glyph < 0x110000);
    if (more == 0) {
        bytes[0] = (char)glyph;
        return 1;
    }
    bytes[0] = (char)((0xf0u << (3 - more) | glyph >> 6 * more) & 0xff);
    for (int i = 1; i <= more; i++)
        bytes[i] = (char)(0x80u | (glyph >> 6 * (more - i) & 0x3f));
    return more + 1;
}
