// SPDX-License-Identifier: MIT
/* Reading and saving the picture of a handle. */
#include "api/handle.h"

#include <stdlib.h>

#include "film/film.h"
#include "film/image_write.h"

static struct develop develop_of(const struct glim *g)
{
    return (struct develop){(float)g->view.lighting.exposure,
                            g->view.lighting.tone};
}

bool glim_is_denoised(struct glim *g)
{
    return g != NULL && g->has_picture && g->engine.options.wants_filter &&
           engine_can_filter(&g->engine);
}

/* Returns the film or the filtered one, or NULL with an error if there is no
 * picture. */
static struct film *film_of(struct glim *g, struct glim_error *err)
{
    struct film *film = NULL;
    struct error why;

    if (!handle_given(g, "handle", err))
        return NULL;
    if (!g->has_picture)
        fail(&why, "picture: found none, expected glim_render() before");
    else if (!glim_is_denoised(g))
        film = render_film(g->engine.render);
    else
        film = engine_filtered(&g->engine, &why);
    if (film == NULL)
        handle_fail(err, &why);
    return film;
}

void glim_get_picture_size(const struct glim *g, int *width, int *height)
{
    const struct film *film =
        g != NULL && g->has_picture ? render_film(g->engine.render) : NULL;

    if (width != NULL)
        *width = film != NULL ? film->width : 0;
    if (height != NULL)
        *height = film != NULL ? film->height : 0;
}

static bool check_count(const struct film *film, size_t count,
                        struct glim_error *err)
{
    size_t expected = 3 * (size_t)film->width * (size_t)film->height;
    struct error why;

    if (count == expected)
        return true;
    fail(&why, "picture: found room for %zu numbers, expected %zu", count,
         expected);
    return handle_fail(err, &why);
}

bool glim_read_floats(struct glim *g, float *rgb, size_t count,
                      struct glim_error *err)
{
    struct film *film =
        handle_given(rgb, "picture", err) ? film_of(g, err) : NULL;

    if (film == NULL || !check_count(film, count, err))
        return false;
    film_linear(film, rgb);
    return true;
}

bool glim_read_bytes(struct glim *g, uint8_t *rgb, size_t count,
                     struct glim_error *err)
{
    struct film *film =
        handle_given(rgb, "picture", err) ? film_of(g, err) : NULL;
    struct frame frame;

    if (film == NULL || !check_count(film, count, err))
        return false;
    frame = (struct frame){.width = film->width,
                           .height = film->height,
                           .rgb = rgb};
    film_resolve(film, develop_of(g), &frame);
    return true;
}

bool glim_save(struct glim *g, const char *path, struct glim_error *err)
{
    struct film *film =
        handle_given(path, "file", err) ? film_of(g, err) : NULL;
    struct image_metadata metadata;
    struct error why;

    if (film == NULL)
        return false;
    metadata = engine_metadata(&g->engine, glim_is_denoised(g));
    return image_write(film, develop_of(g), &metadata, path, &why) ||
           handle_fail(err, &why);
}

const char *glim_save_new(struct glim *g, const char *stem,
                          struct glim_error *err)
{
    struct film *film =
        handle_given(stem, "file", err) ? film_of(g, err) : NULL;
    struct image_metadata metadata;
    struct error why;
    char *name;

    if (film == NULL)
        return NULL;
    metadata = engine_metadata(&g->engine, glim_is_denoised(g));
    name =
        image_write_numbered(film, develop_of(g), &metadata, stem, "png", &why);
    if (name == NULL) {
        handle_fail(err, &why);
        return NULL;
    }
    free(g->saved_name);
    g->saved_name = name;
    return name;
}
