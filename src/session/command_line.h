// SPDX-License-Identifier: MIT
/*
 * command_line.h - the command line
 *
 * Units:     pixels, samples a pixel
 * Ownership: strings point into argv
 * Threads:   main only
 * Errors:    a wrong value is an error that names it, never a silent default
 */
#ifndef GLIM_COMMAND_LINE_H
#define GLIM_COMMAND_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "render/render_loop.h"
#include "terminal/term_caps.h"
#include "session/keymap.h"

/* What a picture shows of a scene. */
enum show_kind {
    SHOW_LIGHT,
    SHOW_PREVIEW,
    SHOW_NORMALS,
    SHOW_FACES,
    SHOW_UVS,
    SHOW_DEPTH,
    SHOW_MATERIALS,
    SHOW_COST,
    SHOW_SAMPLES,
    SHOW_KINDS
};

enum backend_choice {
    BACKEND_CPU,
    BACKEND_OPENCL,
    BACKEND_AUTO /* a GPU through OpenCL where there is one, else the CPU */
};

struct options {
    const char *scene_path;
    bool lacks_scene;        /* and the screen needs one; all else is right */
    const char *view_path;   /* NULL: beside the scene */
    const char *output_path; /* NULL: STEM.png in batch mode */
    const char *stats_path;  /* NULL: none */
    int width_px, height_px; /* 0: not given */
    uint64_t spp;            /* 16 by default */
    bool has_spp;
    int thread_count; /* 0: what the process may use */
    int max_bounces;  /* -1: no limit */
    bool has_max_bounces;
    uint32_t seed;
    bool batch;
    enum show_kind show; /* in batch mode */
    bool up_is_z;
    bool has_crop;
    struct rect crop;
    enum backend_choice backend;
    bool has_backend;
    const char *device;       /* number or a part of a name; NULL: the best */
    const char *kernels_path; /* NULL: the kernels within the program */
    const struct cpu_kernel *paths; /* of --isa; NULL: the best */
    bool watch;                     /* changed files are loaded at once */
    bool phoe_keys;                 /* W S A D Q E as phoe_ray had them */
    struct keymap keys;
    struct term_caps_choice display;
    bool has_color;
    int text_cols, text_rows; /* batch mode writes text; 0: not */
    bool show_help, show_version;
    bool list_devices; /* then there need be no scene */
    bool probe;        /* cl_probe.h: this is the copy; nor need there then */
    uint32_t features; /* that it tries */
};

/* What is so if nobody says anything; no keys yet. */
void options_init(struct options *o);

/* Sets an option that the configuration file may have; NULL: without value.
 * What is wrong is said of `place`. */
bool options_set_taste(struct options *o, const char *name, const char *value,
                       const char *place, struct error *err);

/* Takes argv over what *o holds, and for the screen GLIM_COLOR; settles the
 * keys. */
bool options_parse(struct options *o, int argc, char **argv, struct error *err);

/* Threads of the CPU that work. */
int options_threads(const struct options *o);

/* Names of enum show_kind, as far as files can show it, and NULL. */
extern const char *const options_shows[];

/* The text of --help. */
extern const char options_help[];

#endif
