// SPDX-License-Identifier: MIT
#include "command/command.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/print.h"
#include "command/batch_progress.h"
#include "film/film_error.h"
#include "film/film_file.h"
#include "film/filter/film_filter.h"
#include "film/image_write.h"
#include "render/error_text.h"
#include "render/render_metadata.h"

static struct develop develop_of(const struct film_header *h,
                                 const struct options *o)
{
    struct develop how = {.tone = o->has_tone ? o->tone : h->tone};

    memcpy(&how.exposure, &h->identity.exposure_bits, sizeof how.exposure);
    if (o->has_exposure)
        how.exposure = (float)o->exposure;
    return how;
}

/* Estimates the error as the render does. */
static bool estimate(struct film_file *f, const struct options *o,
                     struct film_error *e, struct error *err)
{
    return film_error(&f->film, develop_of(&f->header, o).exposure, NULL, NULL,
                      e, err);
}

/* ---- info ---- */

static void print_part(const struct film_identity *id)
{
    if (id->width == id->picture_width && id->height == id->picture_height)
        print_line(stdout, "  picture    %dx%d", id->width, id->height);
    else
        print_line(stdout, "  picture    %dx%d at %d,%d of %dx%d", id->width,
                   id->height, id->x, id->y, id->picture_width,
                   id->picture_height);
}

static void print_ranges(const struct film_header *h)
{
    for (size_t i = 0; i < h->range_count; i++)
        print_line(stdout, "  samples    %" PRIu64 " to %" PRIu64,
                   h->ranges[i].first, h->ranges[i].end);
    if (h->total > 0)
        print_line(stdout, "  total      %" PRIu64, h->total);
}

static void print_hashes(const struct film_identity *id)
{
    for (int i = 0; i < FILM_PARTS; i++)
        print_line(stdout, "  %-10s %016" PRIx64,
                   film_part_name((enum film_part)i), id->hashes[i]);
}

static bool print_film(struct film_file *f, const char *path,
                       const struct options *o, struct error *err)
{
    const struct film_header *h = &f->header;
    struct film_error e;
    char error[ERROR_TEXT_BYTES], faults[ERROR_FAULTS_BYTES];

    if (!estimate(f, o, &e, err))
        return false;
    error_text_interval(error, &e);
    print_line(stdout, "%s", path);
    print_line(stdout, "  scene      %s", h->scene);
    print_part(&h->identity);
    print_line(stdout, "  seed       %" PRIu32, h->identity.seed);
    print_ranges(h);
    if (f->is_within_pass)
        print_line(stdout, "  more       some pixels have more samples");
    print_line(stdout, "  adaptive   %s",
               h->identity.is_adaptive ? "yes" : "no");
    print_line(stdout, "  denoising  %s",
               h->identity.has_surfaces ? "possible" : "not possible");
    print_line(stdout, "  error      %s", error);
    if (error_text_faults(faults, h->non_finite, h->saturated))
        print_line(stdout, "  fault      %s", faults);
    print_line(stdout, "  time       %.1f s", seconds_between(0, h->render_ns));
    print_line(stdout, "  version    %s", h->version);
    print_hashes(&h->identity);
    return true;
}

static bool info(const char *path, const struct options *o, struct error *err)
{
    struct film_file f;
    bool ok = film_file_read(&f, path, err) && print_film(&f, path, o, err);

    film_file_free(&f);
    return ok;
}

bool batch_films_info(const struct options *o, struct error *err)
{
    for (int i = 0; i < o->film_count; i++)
        if (!info(o->films[i], o, err))
            return false;
    return print_finish(stdout, err);
}

/* ---- merge ---- */

static void warn_of_gaps(const struct film_header *h)
{
    struct film_range gap;

    for (uint64_t at = 0; film_header_gap(h, &at, &gap);)
        print_line(stderr,
                   "glim: warning: samples %" PRIu64 " to %" PRIu64
                   " are missing",
                   gap.first, gap.end);
}

/* Returns the progress of a render that has made the film. */
static struct render_progress progress_of(const struct film_file *f,
                                          const struct film_error *e)
{
    const struct film_header *h = &f->header;
    struct render_progress p = {.spp_done = film_header_spp(h),
                                .render_ns = h->render_ns,
                                .film_error = *e};

    if (p.spp_done == h->total && !f->is_within_pass)
        p.stopped_by = RENDER_LIMIT_SPP;
    return p;
}

static bool write_picture(struct film_file *f, struct film *film,
                          const struct film_error *e, const char *path,
                          const struct options *o, struct error *err)
{
    const struct film_header *h = &f->header;
    struct render_progress p = progress_of(f, e);
    struct image_metadata metadata =
        render_metadata_film(&p, h, film != &f->film);

    render_metadata_identify(&metadata, &h->identity);
    return image_write(film, develop_of(h, o), &metadata, path, err);
}

/* Writes the film, filtered if the options want that. With --denoise=FILE the
 * filtered picture has a file of its own. */
static bool write_pictures(struct film_file *f, const struct film_error *e,
                           const struct options *o, struct error *err)
{
    struct film filtered = {0}, *film = &f->film;
    bool ok = true;

    if (o->denoise && film->surfaces == NULL)
        return fail(err,
                    "--denoise: found a film without features, expected one "
                    "of a render with --denoise");
    if (o->denoise && !film_filter_applies(film))
        batch_warn_unfiltered();
    else if (o->denoise)
        ok = film_filter_copy(film, options_threads(o), &filtered, err);
    if (ok && filtered.sums != NULL && o->denoise_path) {
        ok = write_picture(f, &filtered, e, o->denoise_path, o, err);
        if (ok)
            batch_say_filtered(o->denoise_path);
    } else if (filtered.sums != NULL) {
        film = &filtered;
    }
    ok = ok && write_picture(f, film, e, o->output_path, o, err);
    film_free(&filtered);
    return ok;
}

static bool write(struct film_file *f, const struct options *o,
                  uint64_t start_ns, struct error *err)
{
    char text[ERROR_TEXT_BYTES];
    struct film_error e;

    if (!estimate(f, o, &e, err))
        return false;
    if (options_output_is_film(o) ? !film_file_write(o->output_path, &f->header,
                                                     &f->film, NULL, NULL, err)
                                  : !write_pictures(f, &e, o, err))
        return false;
    warn_of_gaps(&f->header);
    error_text_interval(text, &e);
    print_line(stderr, "%s: %dx%d, %" PRIu64 " spp, %.1f s, error %s",
               o->output_path, f->film.width, f->film.height,
               film_header_spp(&f->header),
               seconds_between(start_ns, clock_ns()), text);
    batch_warn_of_samples(atomic_load(&f->film.non_finite),
                          atomic_load(&f->film.saturated));
    return true;
}

/* Finds mistakes before films of gigabytes are read. */
static bool check_outputs(const struct options *o, struct error *err)
{
    const char *const paths[] = {o->output_path, o->denoise_path};

    for (int i = 0; i < 2; i++) {
        if (paths[i] == NULL || strcmp(paths[i], "-") == 0)
            continue;
        for (int film = 0; film < o->film_count; film++)
            if (path_is_same(paths[i], o->films[film]))
                return fail(err,
                            "%s: found '%s', one of the films, expected "
                            "another file",
                            i == 0 ? "-o" : "--denoise", paths[i]);
        if (!file_check(paths[i], err))
            return false;
    }
    return true;
}

bool batch_films_merge(const struct options *o, uint64_t start_ns,
                       struct error *err)
{
    struct film_file f = {.shares = NULL};
    bool ok = check_outputs(o, err) && film_file_read(&f, o->films[0], err);

    for (int i = 1; ok && i < o->film_count; i++)
        ok = film_file_join_read(&f, o->films[0], o->films[i], err);
    ok = ok && write(&f, o, start_ns, err);
    film_file_free(&f);
    return ok;
}
