// SPDX-License-Identifier: MIT
#include "session/stats_json.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/print.h"
#include "base/text_stream.h"
#include "glim/version.h"
#include "render/progress.h"
#include "render/render_metadata.h"

/* ---- strings ---- */

void json_write_string(FILE *to, const char *text)
{
    fputc('"', to);
    while (*text) {
        size_t length = utf8_length(text);
        uint32_t code = length == 0 ? 0xfffd : utf8_code(text, length);

        if (length == 0 || !print_shows(code))
            fprintf(to, "\\u%04" PRIx32, code);
        else if (*text == '"' || *text == '\\')
            fprintf(to, "\\%c", *text);
        else
            fwrite(text, 1, length, to);
        text += length > 0 ? length : 1;
    }
    fputc('"', to);
}

/* ---- statistics ---- */

static void write_number(FILE *to, const char *key, uint64_t value)
{
    fprintf(to, "  \"%s\": %" PRIu64 ",\n", key, value);
}

static void write_seconds(FILE *to, const char *key, uint64_t duration_ns)
{
    fprintf(to, "  \"%s\": %.6f,\n", key, seconds_between(0, duration_ns));
}

/* Writes a number, or null if there is none. */
static void write_real(FILE *to, const char *key, double value, bool has_value)
{
    if (has_value)
        fprintf(to, "  \"%s\": %.6g,\n", key, value);
    else
        fprintf(to, "  \"%s\": null,\n", key);
}

static void write_speeds(FILE *to, const struct speeds *speeds)
{
    write_seconds(to, "span_s", speeds->span_ns);
    fputs("  \"speeds\": [", to);
    for (int i = 0; i < speeds->count; i++)
        fprintf(to, "%s%.6g", i > 0 ? ", " : "", speeds_at(speeds, i));
    fputs("],\n", to);
}

static void write_load(FILE *to, const struct session *s, uint64_t render_ns)
{
    const struct backend *b = render_backend(s->engine.render);

    fputs("  \"load\": [", to);
    for (int i = 0; i < s->load.count; i++)
        fprintf(to, "%s%.3f", i > 0 ? ", " : "",
                thread_load_share(&s->load, b, i, render_ns));
    fputs("],\n", to);
}

/* Writes the work of each rank of a cluster, of which there is none without
 * one. */
static void write_ranks(FILE *to, const struct backend *b)
{
    fputs("  \"ranks\": [", to);
    for (int i = 0; i < b->rank_count; i++) {
        struct rank_progress p = b->rank_progress(b, i);

        fprintf(to,
                "%s\n    {\"samples\": %" PRIu64 ", \"answers\": %" PRIu64
                ", \"samples_per_s\": %.6g, \"silent_s\": %.6f}",
                i > 0 ? "," : "", p.samples, p.answers, rank_rate(&p),
                seconds_between(0, p.silent_ns));
    }
    fputs(b->rank_count > 0 ? "\n  ],\n" : "],\n", to);
}

/* Writes the progress as in the screen's panel. Rates exclude everything but
 * rendering. */
static void write_progress(FILE *to, const struct session *s,
                           const struct render_progress *p)
{
    struct render_left left = render_left(p);
    bool has_left = left.limit != RENDER_LIMIT_NONE;
    double seconds = seconds_between(p->build_ns, p->render_ns);
    double rate = seconds > 0 ? (double)p->samples / seconds : 0;
    double rays = seconds > 0 ? (double)p->rays / seconds : 0;

    write_real(to, "percent", 100 * left.part, has_left);
    write_real(to, "samples_per_s", rate, true);
    write_real(to, "rays_per_s", rays, true);
    write_real(to, "left_s", left.ns * 1e-9, has_left);
    write_speeds(to, &s->speeds);
    write_load(to, s, p->render_ns);
    write_ranks(to, render_backend(s->engine.render));
}

/* Counts unused materials of files; material 0 is the default one. */
static uint32_t unused_materials(const struct host_world *host)
{
    uint32_t count = 0;

    for (uint32_t i = 1; i < host->material_count; i++)
        count += !host->material_is_used[i];
    return count;
}

static void write_scene(FILE *to, const struct scene *scene,
                        const struct host_world *host)
{
    write_number(to, "triangles", scene_tri_total(scene));
    write_number(to, "instances", scene->placed_count);
    write_number(to, "dropped_triangles", scene->dropped_count);
    write_number(to, "materials", scene->material_count - 1);
    write_number(to, "unused_materials", unused_materials(host));
    write_number(to, "geometry_bytes", scene_geometry_bytes(scene));
}

static void write_limit(FILE *to, enum render_limit limit)
{
    fputs("  \"stopped_by\": ", to);
    if (limit != RENDER_LIMIT_NONE)
        json_write_string(to, render_limit_name(limit));
    else
        fputs("null", to);
    fputs(",\n", to);
}

static void write_error(FILE *to, const struct film_error *e)
{
    write_real(to, "error", e->error, e->is_known);
    write_real(to, "error_low", e->low, e->is_known);
    write_real(to, "error_high", e->high, e->is_known);
    fprintf(to, "  \"resolved\": %s,\n",
            !e->is_known     ? "null"
            : e->is_resolved ? "true"
                             : "false");
}

static void write_object(FILE *to, const struct session *s, bool is_denoised)
{
    struct render_progress p = render_progress(s->engine.render);
    const struct film *film = render_film(s->engine.render);
    const struct backend *backend = render_backend(s->engine.render);
    uint64_t now_ns = clock_ns();

    fputs("{\n  \"version\": ", to);
    json_write_string(to, GLIM_VERSION);
    fputs(",\n  \"scene\": ", to);
    json_write_string(to, s->options->scene_path);
    fputs(",\n  \"backend\": ", to);
    json_write_string(to, backend->name);
    if (backend->device) {
        fputs(",\n  \"device\": ", to);
        json_write_string(to, backend->device);
        fputs(",\n  \"driver\": ", to);
        json_write_string(to, backend->driver);
    }
    fputs(",\n", to);
    write_number(to, "threads", (uint64_t)backend->thread_count);
    write_number(to, "seed", s->options->seed);
    write_scene(to, &s->engine.scene, &s->engine.world);
    write_number(to, "tree_bytes", backend->tree_bytes);
    write_number(to, "width", (uint64_t)film->width);
    write_number(to, "height", (uint64_t)film->height);
    write_number(to, "spp", p.spp_done);
    fprintf(to, "  \"stopped\": %s,\n",
            p.stopped_by == RENDER_LIMIT_NONE ? "true" : "false");
    write_limit(to, p.stopped_by);
    write_error(to, &p.film_error);
    fprintf(to, "  \"denoised\": %s,\n", is_denoised ? "true" : "false");
    write_number(to, "samples", p.samples);
    write_number(to, "rays", p.rays);
    write_number(to, "non_finite", p.non_finite);
    write_number(to, "saturated", p.saturated);
    write_number(to, "cut_paths", p.cut_paths);
    write_progress(to, s, &p);
    write_seconds(to, "load_s", s->load_ns);
    write_seconds(to, "build_s", p.build_ns);
    /* from the start of the program: the user's waiting time */
    write_seconds(to, "first_picture_s",
                  p.first_picture_ns == 0
                      ? 0
                      : s->restart_ns - s->start_ns + p.first_picture_ns);
    write_seconds(to, "render_s", p.render_ns - p.build_ns);
    fprintf(to, "  \"total_s\": %.6f\n}\n",
            seconds_between(s->start_ns, now_ns));
}

bool stats_json_check(const char *path, struct error *err)
{
    return strcmp(path, "-") == 0 || file_check(path, err);
}

bool stats_json_write(const struct session *s, bool is_denoised,
                      const char *path, struct error *err)
{
    struct text_stream stream;
    char *text;
    size_t size_bytes;
    bool ok;

    if (text_stream_open(&stream))
        write_object(stream.to, s, is_denoised);
    text = text_stream_close(&stream, &size_bytes);
    if (text == NULL) {
        ok = fail(err, "%s: out of memory", path);
    } else if (strcmp(path, "-") == 0) {
        ok = file_write_stdout(text, size_bytes, err);
    } else {
        ok = file_write(path, text, size_bytes, false, NULL, err);
    }
    free(text);
    return ok;
}
