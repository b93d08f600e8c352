// SPDX-License-Identifier: MIT
/*
 * main.c - parses options, starts batch mode or the screen, prints errors
 *
 * No other file prints errors or ends the program.
 *
 * Ownership: owns the options and the session
 * Threads:   main only
 * Errors:    exit status 0 done, 1 failed, 2 usage
 */
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/print.h"
#include "command/batch_progress.h"
#include "command/command.h"
#include "engine/scene_load.h"
#include "glim/version.h"
#include "read/child/draco_child.h"
#include "read/child/import_child.h"
#include "read/child/vdb_read.h"
#include "render/cluster/cluster.h"
#include "render/cpu_dispatch.h"
#include "render/opencl/cl_api.h"
#include "render/opencl/cl_device.h"
#include "render/opencl/cl_source.h"
#include "render/opencl/cl_start.h"
#include "session/autosave_file.h"
#include "session/command_line.h"
#include "session/config.h"
#include "session/picture_options.h"
#include "session/session.h"
#include "session/state_list.h"
#include "studio/start_screen.h"
#include "studio/studio.h"
#include "terminal/xmalloc.h"

/* Width of the lines of --formats. */
#define FORMAT_COLS 72

enum exit_status { EXIT_DONE, EXIT_FAILED, EXIT_USAGE };

/* Opens standard descriptors that are closed at the start. Otherwise the next
 * file that is opened would get their number, and messages would be written
 * into it. */
static void fill_standard_files(void)
{
    for (int fd = 0; fd <= 2; fd++) {
        if (fcntl(fd, F_GETFD) != -1 || errno != EBADF)
            continue;
        /* read-only for standard output, so that writing a picture to it
         * fails */
        if (open("/dev/null", fd == 1 ? O_RDONLY : O_RDWR) != fd)
            return;
    }
}

/* Prints the error. Mistakes in the command line, which all ranks of a cluster
 * have, are printed by rank 0. It alone fails: mpirun ends all when one does,
 * and its line would be lost. */
static int complain(enum exit_status status, const struct error *err)
{
    if (status == EXIT_USAGE && cluster_rank() > 0)
        return EXIT_DONE;
    print_line(stderr, "glim: %s", err->text);
    return status;
}

/* Prints a text such as --help. A failed write is an error. */
static int print_out(const char *text)
{
    struct error err;

    print_lines(stdout, text);
    return print_finish(stdout, &err) ? EXIT_DONE : complain(EXIT_FAILED, &err);
}

static int print_help(void)
{
    options_print_help(stdout);
    return print_out("");
}

static int list_devices(void)
{
    struct cl_devices list;
    struct error err;

    if (!cl_device_list(&list, &err))
        return complain(EXIT_FAILED, &err);
    cl_devices_print(&list, stdout);
    cl_devices_free(&list);
    return print_out("");
}

/* Prints endings of names, as many as fit on each line. */
static void print_endings(const char *endings)
{
    const char *line = endings;
    const char *p = endings;

    while (*p != '\0') {
        const char *end = p + strcspn(p, " ");

        if (end - line > FORMAT_COLS) {
            print_line(stdout, "    %.*s", (int)(p - 1 - line), line);
            line = p;
        }
        p = *end == ' ' ? end + 1 : end;
    }
    print_line(stdout, "    %s", line);
}

static int list_formats(void)
{
    const struct scene_format *f;

    for (uint32_t i = 0; (f = scene_format_number(i)) != NULL; i++) {
        const char *missing = f->missing != NULL ? f->missing() : NULL;

        print_line(stdout, "%s: %s%s%s", f->name, f->about,
                   missing != NULL ? "; missing: " : "",
                   missing != NULL ? missing : "");
        print_endings(f->endings);
    }
    return print_out("");
}

/* Runs this program as the copy that tests a device: cl_probe.h. */
static int probe(const struct options *o)
{
    struct cl_request request = {
        .device = o->device,
        .kernels_path = o->kernels_path,
        .needs_gpu = o->backend == BACKEND_AUTO,
        .features = o->features,
    };
    struct cl_probe probe;
    struct error err;
    bool ok;

    prctl(PR_SET_PDEATHSIG, SIGKILL); /* its parent may end by a signal */
    ok = cl_probe_answer(&probe, &request, &err);
    if (probe.log)
        print_lines(stderr, probe.log);
    if (ok) {
        print_line(stdout, "%s", probe.device);
        print_line(stdout, "%s", probe.verdict);
    }
    cl_probe_free(&probe);
    return ok ? print_out("") : complain(EXIT_FAILED, &err);
}

/* Runs this program as the copy in which a library reads a scene (import.h),
 * unpacks meshes (gltf_draco.h) or voxels (vdb_read.h). The library's own
 * output is lost. */
static int run_library(const struct options *o)
{
    bool ok;
    int fd = dup(1), nowhere = open("/dev/null", O_WRONLY);
    FILE *to = fd >= 0 ? fdopen(fd, "w") : NULL;

    if (to == NULL || nowhere < 0 || dup2(nowhere, 1) < 0)
        return EXIT_FAILED;
    ok = o->is_unpack   ? draco_child(o->library_limits, to)
         : o->is_voxels ? vdb_child(o->scene_path, o->library_limits, to)
                        : import_child(o->scene_path, o->library_limits, to);
    /* the destructors of a library may crash, too */
    _Exit(ok ? EXIT_DONE : EXIT_FAILED);
}

/* Checks that there is a screen for live mode, or a file or pipe for the
 * picture. */
static bool check_terminal(const struct options *o, struct error *err)
{
    if (o->batch) {
        if (o->text_cols == 0 && o->output_path &&
            strcmp(o->output_path, "-") == 0 && isatty(STDOUT_FILENO))
            return fail(err, "-o: found a terminal as standard output, "
                             "expected a file or a pipe");
        return true;
    }
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO))
        return fail(err,
                    "standard %s: found no terminal, expected one or -b to "
                    "render to a file",
                    isatty(STDOUT_FILENO) ? "input" : "output");
    return true;
}

/* Renders for rank 0 with the CPU, or with the device that the options name. */
static bool work(const struct options *o, struct error *err)
{
    struct cl_request request = options_engine(o).device;
    struct backends b = {.cpu = NULL};
    char *log = NULL;
    bool ok = backends_open(&b, o->paths, options_threads(o), err);

    request.features = FEATURES_ALL;
    if (ok && o->backend != BACKEND_CPU &&
        backends_begin_device(&b, &request, err) &&
        !backends_end_device(&b, &log, err) && o->device)
        ok = false;
    free(log);
    ok = ok && cluster_work(b.device ? b.device : b.cpu, err);
    backends_close(&b);
    return ok;
}

/* Starts the ranks, with the options of rank 0 that workers need. MPI does not
 * change the arguments. */
static bool begin_cluster(const struct options *o, struct error *err)
{
    static const char *const backend_names[] = {"cpu", "opencl", "auto"};
    char threads[16];
    const struct {
        const char *name, *value;
    } given[] = {
        {"--backend", backend_names[o->backend]},
        {"--device", o->device},
        {"--kernels", o->kernels_path},
        {"--isa", o->paths ? o->paths->name : NULL},
        {"-t", o->thread_count != 0 ? threads : NULL},
    };
    const char *arguments[2 + 2 * sizeof given / sizeof given[0]] = {
        "--worker"};
    int count = 1;
    char *kernels = cl_source_text(o->kernels_path, err);
    uint64_t version;

    if (!kernels)
        return false;
    version = cl_source_hash(kernels);
    free(kernels);
    snprintf(threads, sizeof threads, "%d", o->thread_count);
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
        if (!given[i].value)
            continue;
        arguments[count++] = given[i].name;
        arguments[count++] = given[i].value;
    }
    return cluster_begin(o->ranks, arguments, version, err);
}

/* Opens scenes on the screen until the person leaves. *listed is the path of a
 * scene that was chosen from the list, for free(), or NULL: one that cannot be
 * read leads back to the list. */
static bool run_screen(struct session *s, struct options *o, uint64_t start_ns,
                       char **listed, int *status, struct error *err)
{
    for (;;) {
        char *next;
        bool ok = batch_open(s, o, start_ns, err);

        if (!ok && *listed == NULL)
            return false;
        if (ok) {
            recent_add(o->scene_path);
            ok = studio_loop(s, status, err);
            next = s->next_scene;
            s->next_scene = NULL;
        } else {
            ok = start_screen_run(o, err->text, &next, status, err);
        }
        if (!ok || *status != EXIT_DONE || next == NULL) {
            free(next);
            return ok;
        }
        session_close(s);
        free(*listed);
        *listed = next;
        options_use_scene(o, next);
    }
}

static bool run(struct session *s, struct options *o, uint64_t start_ns,
                char **listed, int *status, struct error *err)
{
    if (o->command == COMMAND_COMPARE)
        return batch_compare_run(o, status, err);
    if (o->command == COMMAND_CURVE)
        return batch_curve_run(o, start_ns, status, err);
    if (o->command == COMMAND_REFERENCE)
        return batch_reference_run(o, start_ns, status, err);
    if (o->command == COMMAND_INFO)
        return batch_films_info(o, err);
    if (o->command == COMMAND_MERGE || o->command == COMMAND_DEVELOP)
        return batch_films_merge(o, start_ns, err);
    if (!o->batch)
        return run_screen(s, o, start_ns, listed, status, err);
    return batch_open(s, o, start_ns, err) &&
           (o->has_trace ? batch_trace_run(s, err) : batch_run(s, status, err));
}

/* Parses the command line with the scene as its first argument. */
static bool parse_with_scene(struct options *o, char *scene, int argc,
                             char **argv, struct error *err)
{
    static char option[] = "-f";
    char **more = xcalloc((size_t)argc + 2, sizeof *more);
    bool ok;

    more[0] = argv[0];
    more[1] = option;
    more[2] = scene;
    for (int i = 1; i < argc; i++)
        more[i + 2] = argv[i];
    ok = options_parse(o, argc + 2, more, err);
    free(more);
    return ok;
}

/* Parses the command line, and lets the person choose a scene if none is given:
 * *listed, for free(). The error is empty if the person leaves instead. */
static bool parse(struct options *o, int argc, char **argv, char **listed,
                  int *status, struct error *err)
{
    struct options before = *o;

    if (options_parse(o, argc, argv, err))
        return true;
    if (!o->lacks_scene || !isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO) ||
        !start_screen_run(o, NULL, listed, status, err))
        return false;
    if (*listed == NULL) {
        err->text[0] = '\0';
        return false;
    }
    free(o->view_lines);
    *o = before;
    return parse_with_scene(o, *listed, argc, argv, err);
}

/* Prints the version and the instruction sets of the processor, the one in use
 * first. */
static int print_version(void)
{
    char text[128];
    const struct cpu_kernel *p;
    int length = snprintf(text, sizeof text, "glim %s\nisa:", GLIM_VERSION);

    for (int i = 0; (p = cpu_kernel_at(i)) != NULL; i++)
        length += snprintf(text + length, sizeof text - (size_t)length, " %s",
                           p->name);
    snprintf(text + length, sizeof text - (size_t)length, "\n");
    return print_out(text);
}

int main(int argc, char **argv)
{
    static struct options options; /* as its strings, until the end */
    struct session session = {0};
    struct options configured;
    struct error err, config_err;
    char *listed = NULL;
    int status;

    memory_init();
    fill_standard_files();
    /* character encoding only: numbers keep the decimal point */
    setlocale(LC_CTYPE, "");
    options_init(&options);
    /* an error there must not prevent --help */
    bool has_config = config_read(&options, &config_err);
    configured = options;
    status = EXIT_USAGE;
    if (!parse(&options, argc, argv, &listed, &status, &err))
        return err.text[0] == '\0' ? status : complain(EXIT_USAGE, &err);
    status = EXIT_DONE;
    uint64_t start_ns = clock_ns();
    if (options.show_help)
        return print_help();
    if (options.show_version)
        return print_version();
    if (!has_config)
        return complain(EXIT_USAGE, &config_err);
    cl_environment_prepare(options.thread_count);
    if (options.list_devices)
        return list_devices();
    if (options.list_formats)
        return list_formats();
    if (options.list_sessions)
        return autosave_print_list(stdout, &err) ? print_out("")
                                                 : complain(EXIT_FAILED, &err);
    if (options.probe)
        return probe(&options);
    if (options.is_import || options.is_unpack || options.is_voxels)
        return run_library(&options);
    if (options.has_trace && options.picture_path != NULL &&
        !picture_options_parse(&options, &configured, argc, argv, &err))
        return complain(EXIT_FAILED, &err);
    if (!options.is_worker && cluster_rank() == 0 &&
        !check_terminal(&options, &err))
        return complain(EXIT_USAGE, &err);
    /* the failing write returns the error */
    signal(SIGXFSZ, SIG_IGN);
    if (options.batch || options.is_worker)
        signal(SIGPIPE, SIG_IGN);
    if ((options.ranks > 1 || options.is_worker || cluster_is_launched()) &&
        !begin_cluster(&options, &err)) {
        status = cluster_rank() > 0 ? EXIT_FAILED : complain(EXIT_FAILED, &err);
        cluster_end(true);
        return status;
    }
    if (cluster_rank() > 0) {
        if (!work(&options, &err))
            status = complain(EXIT_FAILED, &err);
        cluster_end(status != EXIT_DONE);
        return status;
    }
    if (!run(&session, &options, start_ns, &listed, &status, &err))
        /* as cmp(1): 1 means that the pictures differ */
        status = complain(options.command == COMMAND_COMPARE ? EXIT_USAGE
                                                             : EXIT_FAILED,
                          &err);
    session_close(&session);
    cluster_end(false);
    free(listed);
    return status;
}
