// SPDX-License-Identifier: MIT
#include "terminal/glyphs.h"

#include <assert.h>
#include <stddef.h>

/* Block elements of 2x4 dots: quadrants and lower quarters. The upper quarters
 * are their inverses. */
static const struct {
    unsigned mask;
    uint32_t glyph;
} blocks[] = {
    {0x00, ' '},    {0x05, 0x2598},     {0x0a, 0x259d}, {0x0f, CELL_UPPER},
    {0x50, 0x2596}, {0x55, 0x258c},     {0x5a, 0x259e}, {0x5f, 0x259b},
    {0xa0, 0x2597}, {0xa5, 0x259a},     {0xaa, 0x2590}, {0xaf, 0x259c},
    {0xc0, 0x2582}, {0xf0, CELL_LOWER}, {0xf5, 0x2599}, {0xfa, 0x259f},
    {0xfc, 0x2586}, {0xff, CELL_FULL},
};
#define BLOCKS (sizeof blocks / sizeof blocks[0])

/* Braille code points: U+2800 plus these bits for each dot. The standard
 * numbers the first three rows by columns, then the fourth. */
#define BRAILLE_FIRST 0x2800u
static const uint8_t braille_dots[8] = {1, 8, 2, 16, 4, 32, 64, 128};

static const struct {
    struct glyph_grid grid;
    const char *name;
} kinds[GLYPHS_COUNT] = {
    [GLYPHS_HALF] = {{1, 2}, "half blocks"},
    [GLYPHS_BLOCK] = {{2, 4}, "blocks"},
    [GLYPHS_BRAILLE] = {{2, 4}, "braille"},
    [GLYPHS_SHADE] = {{1, 1}, "shades"},
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

uint32_t glyph_of_block(unsigned mask)
{
    for (size_t i = 0; i < BLOCKS; i++)
        if (blocks[i].mask == mask)
            return blocks[i].glyph;
    return 0;
}

bool glyph_block_mask(uint32_t glyph, unsigned *mask)
{
    size_t i = 0;

    while (i < BLOCKS && blocks[i].glyph != glyph)
        i++;
    *mask = i < BLOCKS ? blocks[i].mask : 0;
    return i < BLOCKS;
}

uint32_t glyph_of_braille(unsigned mask)
{
    uint32_t glyph = BRAILLE_FIRST;

    for (int i = 0; i < GLYPH_DOTS; i++)
        glyph += mask >> i & 1 ? braille_dots[i] : 0;
    return mask ? glyph : ' ';
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
