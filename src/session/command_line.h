// SPDX-License-Identifier: MIT
/*
 * command_line.h - the options and operands of the command line, what they mean
 * together, and the text of --help
 *
 * Units:     pixels, samples per pixel
 * Ownership: strings point into argv; view_lines and films are allocated once
 * Threads:   main only
 * Errors:    a wrong value is an error that names it, never a silent default
 */
#ifndef GLIM_COMMAND_LINE_H
#define GLIM_COMMAND_LINE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"
#include "base/library_child.h"
#include "engine/engine.h"
#include "image/image_metadata.h"
#include "session/keymap.h"
#include "terminal/term_caps.h"
#include "kernels/path_types.h"

/* Property of the scene that the picture shows. */
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
    SHOW_ERROR,
    SHOW_KINDS
};

/* Property of the first surfaces in a file of its own. */
enum aov_kind {
    AOV_ALBEDO,
    AOV_NORMALS,
    AOV_POSITION,
    AOV_DEPTH,
    AOV_UV,
    AOV_OBJECT,
    AOV_MATERIAL,
    AOV_KINDS
};

enum backend_choice {
    BACKEND_CPU,
    BACKEND_OPENCL,
    BACKEND_AUTO /* a GPU through OpenCL if there is one, else the CPU */
};

/* Light from cells of space: light_cells.h, radiance_cells.h. */
enum gi_kind { GI_CELLS, GI_EXACT };

/* First word of the command line. */
enum sub_command {
    COMMAND_RENDER, /* without a word: live mode or -b */
    COMMAND_COMPARE,
    COMMAND_CURVE,
    COMMAND_REFERENCE,
    COMMAND_INFO,
    COMMAND_MERGE,
    COMMAND_DEVELOP
};

struct options {
    enum sub_command command;
    const char *picture_path;       /* compare: the first picture; --trace: its
                                       picture, */
    struct image_metadata *picture; /* the texts in its file, */
    char *view_text;                /* and its view; NULL: there is none */
    const char *reference_path;     /* compare: the second picture; curve */
    int seed_count;                 /* reference: independent renders */
    char *const *arguments;         /* the command line, ending with NULL */
    const char *csv_path;           /* curve: NULL: no such file */
    /* info, merge, develop: the films; the array lives as long as the program
     */
    const char **films;
    int film_count;
    bool has_exposure, has_tone; /* merge, develop: not those of the render */
    double exposure;             /* in stops */
    uint32_t tone;               /* enum tone */
    char *view_lines;            /* over those of the view file; NULL: none */
    bool has_sky;                /* in view_lines */
    const char *camera;          /* number or name; NULL: that of the view */
    struct scene_choice choice;  /* of the scene file */
    int turntable_count, fly_count; /* frames; 0: none */
    uint32_t aovs;                  /* bits 1 << enum aov_kind */
    bool has_frames;
    int first_frame, last_frame;
    double fps;          /* frames of a second of animation */
    int tile_count;      /* compare: most tiles each way */
    double false_alarms; /* compare: probability of any */
    const char *scene_path;
    bool lacks_scene;        /* no scene was given and the screen needs one */
    const char *view_path;   /* NULL: beside the scene */
    const char *output_path; /* NULL: STEM.png in batch mode */
    const char *stats_path;  /* NULL: no statistics */
    const char *error_map_path;  /* NULL: no map */
    const char *film_path;       /* film at the end; NULL: none */
    const char *checkpoint_path; /* film in between and at the end */
    uint64_t checkpoint_ns;      /* time between checkpoints */
    bool has_checkpoint_interval;
    const char *resume_path;      /* film to go on from; NULL: none */
    int share_index, share_count; /* 1 to the count; 0 of 0: all samples */
    int width_px, height_px;      /* 0 if not given */
    uint64_t spp;                 /* samples per pixel */
    bool has_spp;
    double error_limit;         /* relative; 0: none */
    bool adaptive, no_adaptive; /* neither: options_adaptive() */
    enum gi_kind gi;
    uint64_t time_ns; /* limit of the time of rendering; 0: none */
    int thread_count; /* 0: all that the process may use */
    int max_bounces;  /* -1: no limit */
    bool has_max_bounces;
    uint32_t seed;
    bool has_seed;
    bool has_trace;         /* print the path of a sample */
    struct sample_id trace; /* in pixels of the crop */
    bool batch;
    bool no_filter;           /* live mode shows unfiltered pictures */
    bool denoise;             /* filter the picture, in batch mode */
    const char *denoise_path; /* file of the filtered picture; NULL: -o */
    enum show_kind show;      /* in batch mode */
    enum scene_up up;
    bool has_sun;
    double sun_azimuth_deg, sun_elevation_deg;
    double turbidity; /* 0 if not given */
    bool has_crop;
    struct rect crop;
    enum backend_choice backend;
    bool has_backend;
    const char *device; /* number or part of a name; NULL: the best device */
    const char *kernels_path;       /* NULL: built-in kernels */
    const struct cpu_kernel *paths; /* from --isa; NULL: the best */
    bool watch;                     /* reload files when they change */
    bool phoe_keys;                 /* phoe_ray's keys W S A D Q E */
    struct keymap keys;
    struct term_caps_choice display;
    bool has_color;
    int text_cols,
        text_rows; /* size of text output in batch mode; 0: a picture */
    bool show_help, show_version;
    bool list_devices;  /* list devices; no scene is needed */
    bool list_formats;  /* list formats of scenes; no scene is needed */
    bool list_sessions; /* list kept sessions; no scene is needed */
    int ranks;          /* processes of a cluster to start; 0: none */
    bool is_worker;     /* render for rank 0; no scene is needed */
    bool probe;         /* test a device, see cl_probe.h; no scene is needed */
    uint64_t features;  /* features for the test */
    bool is_import;     /* send a scene, see import.h; or */
    bool is_unpack;     /* meshes, see gltf_draco.h; or */
    bool is_voxels;     /* a grid, see vdb_read.h, with these limits */
    struct library_limits library_limits;
};

/* Sets the defaults. There are no keys yet. */
void options_init(struct options *o);

/* Sets an option from the configuration file; `value` is NULL if it has none.
 * `place` is used for messages. */
bool options_set_configured(struct options *o, const char *name,
                            const char *value, const char *place,
                            struct error *err);

/* Parses argv over the values in *o, takes GLIM_COLOR for the screen and
 * completes the keys. */
bool options_parse(struct options *o, int argc, char **argv, struct error *err);

/* Prints the text of --help. */
void options_print_help(FILE *to);

/* Returns true if pixels with more error are to get more samples. */
bool options_adaptive(const struct options *o);

/* Returns true if the output is a video of several frames. */
bool options_output_is_video(const struct options *o);

/* Returns true if the output of merge is a film. */
bool options_output_is_film(const struct options *o);

/* Returns the limits of a render to a file and of normal mode. The samples are
 * one of them if they were given, or if there is no other. */
struct render_limits options_limits(const struct options *o);

/* Names another scene. What belongs to the scene before is forgotten: its view,
 * camera, light and crop. The path stays the caller's. */
void options_use_scene(struct options *o, const char *path);

/* Returns the number of CPU threads. */
int options_threads(const struct options *o);

/* Returns what the engine takes of them. */
struct engine_options options_engine(const struct options *o);

/* Names of enum show_kind in batch mode, and of enum aov_kind, ending with
 * NULL. */
extern const char *const options_shows[];
extern const char *const options_aovs[];

#endif
