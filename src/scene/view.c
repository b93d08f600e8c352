// SPDX-License-Identifier: MIT
#include "scene/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "world/light/daylight.h"

/* ---- names ---- */

/* Copies the text inside the quotes to `name`, which has room for the rest of
 * the file. Returns false if the closing quote is missing. */
static bool read_quoted(struct lexer *lex, char *name)
{
    for (lex->p++; lex->p < lex->end; lex->p++) {
        if (*lex->p == '\n' || *lex->p == '\r')
            return false;
        if (*lex->p == '"') {
            lex->p++;
            if (lex->p == lex->end || *lex->p != '"') {
                *name = '\0';
                return true;
            }
        }
        *name++ = *lex->p;
    }
    return false;
}

bool quoted_name_read(struct lexer *lex, char **name)
{
    struct word word;

    *name = NULL;
    if (lexer_at_line_end(lex))
        return true;
    if (*lex->p != '"') {
        word = lexer_word(lex);
        *name = strndup(word.start, word.length);
        return *name != NULL;
    }
    *name = malloc((size_t)(lex->end - lex->p));
    if (*name == NULL)
        return false;
    if (!read_quoted(lex, *name)) {
        free(*name);
        *name = NULL;
    }
    return true;
}

void quoted_name_write(FILE *to, const char *name)
{
    if (*name != '\0' && strpbrk(name, " \t\v\f\"#\\") == NULL) {
        fputs(name, to);
        return;
    }
    fputc('"', to);
    for (const char *p = name; *p != '\0'; p++) {
        if (*p == '"')
            fputc('"', to);
        fputc(*p, to);
    }
    fputc('"', to);
}

/* ---- assignments ---- */

bool assigns_read(struct assigns *a, struct lexer *lex, bool *has_names)
{
    char *object, *material = NULL;
    bool ok = quoted_name_read(lex, &object) &&
              (object == NULL || quoted_name_read(lex, &material));

    *has_names = ok && material != NULL && lexer_at_line_end(lex);
    if (*has_names)
        ok = assigns_set(a, object, material);
    free(object);
    free(material);
    return ok;
}

void assigns_write(const struct assigns *a, FILE *to)
{
    for (size_t i = 0; i < a->count; i++) {
        fputs("assign ", to);
        quoted_name_write(to, a->items[i].object);
        fputc(' ', to);
        quoted_name_write(to, a->items[i].material);
        fputc('\n', to);
    }
}

static void remove_at(struct assigns *a, size_t i)
{
    free(a->items[i].object);
    free(a->items[i].material);
    a->count--;
    memmove(&a->items[i], &a->items[i + 1],
            (a->count - i) * sizeof a->items[0]);
}

/* Adds an assignment at the end. Returns false when memory is out. */
static bool append(struct assigns *a, const char *object, const char *material)
{
    struct assign item = {strdup(object), strdup(material)};
    struct assign *items =
        realloc(a->items, (a->count + 1) * sizeof a->items[0]);

    if (items != NULL)
        a->items = items;
    if (items == NULL || item.object == NULL || item.material == NULL) {
        free(item.object);
        free(item.material);
        return false;
    }
    a->items[a->count++] = item;
    return true;
}

bool assigns_set(struct assigns *a, const char *object, const char *material)
{
    for (size_t i = 0; i < a->count; i++) {
        if (strcmp(a->items[i].object, object) == 0) {
            remove_at(a, i);
            break;
        }
    }
    return material == NULL || append(a, object, material);
}

bool assigns_copy(struct assigns *to, const struct assigns *from)
{
    struct assigns copy = {0};
    bool ok = true;

    for (size_t i = 0; ok && i < from->count; i++)
        ok = append(&copy, from->items[i].object, from->items[i].material);
    if (!ok) {
        assigns_free(&copy);
        return false;
    }
    assigns_free(to);
    *to = copy;
    return true;
}

void assigns_free(struct assigns *a)
{
    while (a->count > 0)
        remove_at(a, a->count - 1);
    free(a->items);
    *a = (struct assigns){0};
}

/* ---- views ---- */

const char *const view_tones[TONES] = {
    [TONE_LINEAR] = "linear",
    [TONE_REINHARD] = "reinhard",
    [TONE_ACES] = "aces",
};

void view_init(struct view *view)
{
    *view = (struct view){
        .pose = {.up = {0, 1, 0}, .fovy_deg = 40},
        .lighting = {.sky_strength = 1,
                     .sun = {.azimuth_deg = 135,
                             .elevation_deg = 45,
                             .turbidity = TURBIDITY_DEFAULT}},
        .width_px = 1024,
        .height_px = 576,
        .max_bounces = -1,
    };
}

void view_copy_frame(struct view *view, const struct view *from)
{
    view->width_px = from->width_px;
    view->height_px = from->height_px;
    view->has_size = from->has_size;
    view->max_bounces = from->max_bounces;
}

/* Scales `side` by to / from and clamps it to the sides of a picture: with the
 * aspect ratio from : to, the other side. */
static int other_side(int side, int from, int to)
{
    double other = round((double)side * to / from);

    return other < 1.0 ? 1 : other > VIEW_SIDE_MAX ? VIEW_SIDE_MAX : (int)other;
}

void view_set_size(struct view *view, int width_px, int height_px)
{
    if (height_px == 0)
        height_px = other_side(width_px, view->width_px, view->height_px);
    else if (width_px == 0)
        width_px = other_side(height_px, view->height_px, view->width_px);
    view->width_px = width_px;
    view->height_px = height_px;
    view->has_size = true;
}

bool view_set_sun(struct view *view, double azimuth_deg, double elevation_deg,
                  struct error *err)
{
    struct sun *sun = &view->lighting.sun;

    if (!(fabs(azimuth_deg) <= SUN_AZIMUTH_MAX &&
          fabs(elevation_deg) <= SUN_ELEVATION_MAX))
        return fail(err,
                    "sun: found %g,%g, expected an azimuth from -%d to %d and "
                    "an elevation from -%d to %d degrees",
                    azimuth_deg, elevation_deg, SUN_AZIMUTH_MAX,
                    SUN_AZIMUTH_MAX, SUN_ELEVATION_MAX, SUN_ELEVATION_MAX);
    sun->is_on = true;
    sun->azimuth_deg = azimuth_deg;
    sun->elevation_deg = elevation_deg;
    return true;
}

bool view_set_turbidity(struct view *view, double turbidity, struct error *err)
{
    if (!(turbidity >= TURBIDITY_MIN && turbidity <= TURBIDITY_MAX))
        return fail(err, "turbidity: found %g, expected %g to %g", turbidity,
                    TURBIDITY_MIN, TURBIDITY_MAX);
    if (!view->lighting.sun.is_on)
        return fail(err, "turbidity: found no sun, expected one in the options "
                         "or the view file");
    view->lighting.sun.turbidity = turbidity;
    return true;
}

bool view_has_part(const struct view *view, int x, int y, int width, int height)
{
    return x >= 0 && y >= 0 && width > 0 && height > 0 &&
           width <= view->width_px && height <= view->height_px &&
           x <= view->width_px - width && y <= view->height_px - height;
}

bool lighting_copy(struct lighting *to, const struct lighting *from)
{
    char *sky_path = from->sky_path ? strdup(from->sky_path) : NULL;

    if (!sky_path && from->sky_path)
        return false;
    free(to->sky_path);
    *to = *from;
    to->sky_path = sky_path; /* replaces the pointer of `from` */
    return true;
}

static bool is_same_path(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

bool sun_has_same_sky(const struct sun *a, const struct sun *b)
{
    return a->is_on == b->is_on && a->elevation_deg == b->elevation_deg &&
           a->turbidity == b->turbidity;
}

bool fog_is_there(const struct fog *fog)
{
    double most = 0;

    for (int c = 0; c < 3; c++)
        most = fmax(most, fmax(fog->scatter[c], fog->absorb[c]));
    return most > 0;
}

bool lighting_is_same_light(const struct lighting *a, const struct lighting *b)
{
    return memcmp(a->background, b->background, sizeof a->background) == 0 &&
           a->has_background == b->has_background &&
           is_same_path(a->sky_path, b->sky_path) &&
           a->sky_strength == b->sky_strength &&
           a->sky_rotation_deg == b->sky_rotation_deg &&
           sun_has_same_sky(&a->sun, &b->sun) &&
           a->sun.azimuth_deg == b->sun.azimuth_deg &&
           memcmp(&a->fog, &b->fog, sizeof a->fog) == 0;
}

bool lighting_equal(const struct lighting *a, const struct lighting *b)
{
    return lighting_is_same_light(a, b) && a->exposure == b->exposure &&
           a->tone == b->tone;
}

bool view_copy(struct view *to, const struct view *from)
{
    struct view copy = *from;

    copy.lighting.sky_path = NULL;
    copy.assigns = (struct assigns){0};
    copy.lamps = (struct lamps){0};
    copy.smokes = (struct smokes){.count = 0};
    if (!lighting_copy(&copy.lighting, &from->lighting) ||
        !assigns_copy(&copy.assigns, &from->assigns) ||
        !lamps_copy(&copy.lamps, &from->lamps) ||
        !smokes_copy(&copy.smokes, &from->smokes)) {
        view_free(&copy);
        return false;
    }
    view_free(to);
    *to = copy;
    return true;
}

void view_keep_camera(struct view *view, const struct view *now,
                      const struct view *before, const struct view *after)
{
    /* a camera that the program placed (without has_camera) follows the
     * scene */
    if (!after->has_camera ||
        (before->has_camera &&
         memcmp(&before->pose, &after->pose, sizeof after->pose) == 0))
        view->pose = now->pose;
    for (int i = 0; i < VIEW_SHOTS; i++) {
        if (before->has_shot[i] != after->has_shot[i] ||
            memcmp(&before->shots[i], &after->shots[i],
                   sizeof after->shots[i]) != 0)
            continue;
        view->shots[i] = now->shots[i];
        view->has_shot[i] = now->has_shot[i];
    }
}

void view_free(struct view *view)
{
    free(view->lighting.sky_path);
    assigns_free(&view->assigns);
    lamps_free(&view->lamps);
    smokes_free(&view->smokes);
    *view = (struct view){0};
}
