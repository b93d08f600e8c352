// SPDX-License-Identifier: MIT
/*
 * test_cl_environment.c - what drivers depend on: the environment, the cache
 * folder, the signals
 *
 * PoCL's effects on a process are tested in child processes, which are started
 * with posix_spawn because a driver does not survive a fork.
 */
#include "tests/unit/check.h"
#include "tests/unit/folder.h"

#include <spawn.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/thread_pool.h"
#include "render/opencl/cl_api.h"
#include "render/opencl/cl_device.h"

/* Exit status of a child process that finds no PoCL. */
#define NO_POCL 77

#define SIGNAL_MAX 64

extern char **environ;

static void is_set(const char *name, const char *expected)
{
    const char *value = getenv(name);

    if (!expected) {
        assert_null(value);
        return;
    }
    check_or_say(value, name);
    assert_string_equal(value, expected);
}

static void forget_environment(void)
{
    static const char *const names[] = {"POCL_MAX_PTHREAD_COUNT",
                                        "POCL_CPU_MAX_CU_COUNT",
                                        "POCL_SIGFPE_HANDLER",
                                        "POCL_CACHE_DIR",
                                        "XDG_CACHE_HOME",
                                        "HOME"};

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        unsetenv(names[i]);
}

static void environment_has_threads_and_no_sigfpe(void **state)
{
    char count[16];

    (void)state;
    forget_environment();
    cl_environment_prepare(5);
    is_set("POCL_MAX_PTHREAD_COUNT", "5");
    is_set("POCL_CPU_MAX_CU_COUNT", "5");
    is_set("POCL_SIGFPE_HANDLER", "0");

    forget_environment();
    cl_environment_prepare(0);
    snprintf(count, sizeof count, "%d", usable_threads());
    is_set("POCL_MAX_PTHREAD_COUNT", count);

    setenv("POCL_MAX_PTHREAD_COUNT", "2", 1);
    setenv("POCL_SIGFPE_HANDLER", "1", 1);
    cl_environment_prepare(7);
    is_set("POCL_MAX_PTHREAD_COUNT", "2"); /* set by the user */
    is_set("POCL_SIGFPE_HANDLER", "0");    /* never set */
}

/* Checks PoCL's folder for these values; NULL is an unset variable. */
static void check_cache_choice(const char *cache_home, const char *home,
                               const char *own, const char *expected)
{
    forget_environment();
    if (cache_home)
        setenv("XDG_CACHE_HOME", cache_home, 1);
    if (home)
        setenv("HOME", home, 1);
    if (own)
        setenv("POCL_CACHE_DIR", own, 1);
    cl_environment_prepare(1);
    is_set("POCL_CACHE_DIR", expected);
}

static void cache_is_in_the_first_usable_folder(void **state)
{
    (void)state;
    check_cache_choice("/c", "/h", NULL, "/c/glim/pocl");
    check_cache_choice(NULL, "/h", NULL, "/h/.cache/glim/pocl");
    check_cache_choice("", "/h", NULL, "/h/.cache/glim/pocl");
    check_cache_choice("relative", "/h", NULL, "/h/.cache/glim/pocl");
    check_cache_choice("relative", NULL, NULL, NULL);
    check_cache_choice(NULL, NULL, NULL, NULL);
    check_cache_choice("/c", "/h", "/own", "/own");
}

static bool cache_is_made(const char *within, struct error *err)
{
    char path[256];

    snprintf(path, sizeof path, "%s/%s", folder, within);
    setenv("POCL_CACHE_DIR", path, 1);
    return cl_cache_open(err);
}

static bool is_folder(const char *within)
{
    char path[256];
    struct stat st;

    snprintf(path, sizeof path, "%s/%s", folder, within);
    return stat(path, &st) == 0 && S_ISDIR(st.st_mode);
}

static void cache_fails(const char *within, const char *why)
{
    struct error err;
    char expected[256];

    assert_false(cache_is_made(within, &err));
    snprintf(expected, sizeof expected, "%s/%s: %s", folder, within, why);
    assert_string_equal(err.text, expected);
}

static void cache_folders_are_made(void **state)
{
    struct error err;
    char path[256];

    (void)state;
    assert_true(cache_is_made("a/b c//d/", &err));
    assert_true(is_folder("a/b c/d"));
    assert_true(cache_is_made("a", &err));
    snprintf(path, sizeof path, "%s/file", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    cache_fails("file", "Not a directory");
    cache_fails("file/below", "Not a directory");
    unsetenv("POCL_CACHE_DIR");
    assert_true(cl_cache_open(&err)); /* PoCL finds its own folder */
}

static void mark(int number)
{
    (void)number;
}

/* These are the signals that handlers of LLVM (by its sources) and PoCL
 * take. */
static void signal_actions_are_restored(void **state)
{
    static const int numbers[] = {SIGHUP,  SIGINT,  SIGQUIT, SIGILL,  SIGTRAP,
                                  SIGABRT, SIGBUS,  SIGSEGV, SIGUSR1, SIGUSR2,
                                  SIGTERM, SIGXCPU, SIGXFSZ, SIGSYS,  SIGFPE};
    struct sigaction before[SIGNAL_MAX + 1];
    struct sigaction ours = {.sa_handler = mark, .sa_flags = SA_RESTART};
    struct sigaction theirs = {.sa_handler = SIG_IGN};
    struct cl_signals kept;
    struct sigaction now;

    (void)state;
    sigaddset(&ours.sa_mask, SIGWINCH);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        sigaction(numbers[i], &ours, &before[numbers[i]]);
    cl_signals_keep(&kept);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        sigaction(numbers[i], &theirs, NULL);
    cl_signals_put_back(&kept);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        sigaction(numbers[i], &before[numbers[i]], &now);
        assert_ptr_equal(now.sa_handler, mark);
        assert_true((now.sa_flags & SA_RESTART) != 0);
        assert_true(sigismember(&now.sa_mask, SIGWINCH));
    }
}

/* Starts the driver in a child process and returns PoCL's device and its number
 * of units. Ends the process if there is none. */
static cl_device_id start_pocl(int thread_count, int *unit_count)
{
    struct cl_devices list;
    struct error err;

    cl_environment_prepare(thread_count);
    if (!cl_device_list(&list, &err))
        _exit(NO_POCL);
    const struct cl_device *pocl = cl_device_find(&list, "portable", &err);
    if (!pocl)
        _exit(NO_POCL);
    cl_device_id id = pocl->id;
    *unit_count = (int)pocl->compute_units;
    cl_devices_free(&list);
    return id;
}

static volatile int zero;

__attribute__((no_sanitize("undefined"))) static int child_divides(void)
{
    int unit_count;

    start_pocl(1, &unit_count);
    return 7 / zero; /* normally ends the process */
}

static int child_counts(void)
{
    int unit_count;

    start_pocl(3, &unit_count);
    return unit_count;
}

/* Builds a kernel and runs it once. Returns the number it has written, 42 if
 * all is well. */
static int run_kernel(cl_device_id id)
{
    static const char *const source =
        "__kernel void answer(__global int *out) { *out = 42; }";
    struct error err;
    const struct cl_api *cl = cl_api_open(&err);
    const char *text = source;
    cl_context context = cl->CreateContext(NULL, 1, &id, NULL, NULL, NULL);
    cl_command_queue queue = cl->CreateCommandQueue(context, id, 0, NULL);
    cl_program program =
        cl->CreateProgramWithSource(context, 1, &text, NULL, NULL);
    cl->BuildProgram(program, 1, &id, "-cl-std=CL1.2", NULL, NULL);
    cl_kernel kernel = cl->CreateKernel(program, "answer", NULL);
    cl_mem out = cl->CreateBuffer(context, CL_MEM_READ_WRITE, sizeof(cl_int),
                                  NULL, NULL);
    cl_int value = 0;
    size_t one = 1;

    cl->SetKernelArg(kernel, 0, sizeof out, &out);
    cl->EnqueueNDRangeKernel(queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL);
    cl->EnqueueReadBuffer(queue, out, CL_TRUE, 0, sizeof value, &value, 0, NULL,
                          NULL);
    cl->ReleaseMemObject(out);
    cl->ReleaseKernel(kernel);
    cl->ReleaseProgram(program);
    cl->ReleaseCommandQueue(queue);
    cl->ReleaseContext(context);
    return value;
}

static volatile sig_atomic_t caught;

static void on_signal(int number)
{
    (void)number;
    caught = caught + 1;
}

/* Compares actions except for a flag that the Linux kernel adds to actions once
 * set. */
static bool is_same_action(const struct sigaction *a, const struct sigaction *b)
{
    int flags =
        SA_RESTART | SA_SIGINFO | SA_ONSTACK | SA_NODEFER | SA_RESETHAND;

    return a->sa_handler == b->sa_handler &&
           (a->sa_flags & flags) == (b->sa_flags & flags);
}

/* Returns 0 if all signals, including unknown ones, are as before, or the first
 * that is not. */
static int child_keeps_signals(void)
{
    struct sigaction before[SIGNAL_MAX + 1] = {0};
    struct sigaction ours = {.sa_handler = on_signal};
    struct cl_signals kept;
    int unit_count;

    sigaction(SIGINT, &ours, NULL);
    sigaction(SIGTERM, &ours, NULL);
    for (int i = 1; i <= SIGNAL_MAX; i++)
        sigaction(i, NULL, &before[i]);
    cl_device_id id = start_pocl(1, &unit_count);
    cl_signals_keep(&kept);
    int answer = run_kernel(id);
    cl_signals_put_back(&kept);
    if (answer != 42)
        return 99;
    for (int i = 1; i <= SIGNAL_MAX; i++) {
        struct sigaction now = {0};

        sigaction(i, NULL, &now);
        if (!is_same_action(&now, &before[i]))
            return i;
    }
    raise(SIGINT);
    raise(SIGTERM);
    return caught == 2 ? 0 : 98;
}

static const struct {
    const char *name;
    int (*run)(void);
} children[] = {{"divides", child_divides},
                {"counts", child_counts},
                {"keeps-signals", child_keeps_signals}};

/* Returns the child's status as of waitpid(), or skips the test without
 * PoCL. */
static int status_of(const char *name)
{
    char program[] = "/proc/self/exe";
    char *argv[] = {program, strdup(name), NULL};
    pid_t child;
    int status;

    setenv("POCL_CACHE_DIR", folder, 1);
    unsetenv("POCL_MAX_PTHREAD_COUNT");
    unsetenv("POCL_CPU_MAX_CU_COUNT");
    unsetenv("POCL_SIGFPE_HANDLER");
    setenv("ASAN_OPTIONS", "handle_sigfpe=0:use_sigaltstack=0", 1);
    setenv("TSAN_OPTIONS", "handle_sigfpe=0", 1);
    assert_int_equal(posix_spawn(&child, program, NULL, NULL, argv, environ),
                     0);
    free(argv[1]);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == NO_POCL) {
        print_message("skip: no PoCL here\n");
        skip();
    }
    return status;
}

static void division_by_zero_ends_the_process(void **state)
{
    (void)state;
#if defined(__x86_64__) || defined(__i386__)
    int status = status_of("divides");
    assert_true(WIFSIGNALED(status));
    assert_int_equal(WTERMSIG(status), SIGFPE);
#else
    print_message("skip: integers may be divided by zero here\n");
    skip();
#endif
}

static void driver_has_the_given_number_of_threads(void **state)
{
    (void)state;
    int status = status_of("counts");
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 3);
}

static void driver_leaves_signals_alone(void **state)
{
    (void)state;
    int status = status_of("keeps-signals");
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

static int run_child(const char *name)
{
    for (size_t i = 0; i < sizeof children / sizeof children[0]; i++) {
        if (strcmp(children[i].name, name) == 0)
            return children[i].run();
    }
    return 97;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(environment_has_threads_and_no_sigfpe),
        cmocka_unit_test(cache_is_in_the_first_usable_folder),
        cmocka_unit_test(cache_folders_are_made),
        cmocka_unit_test(signal_actions_are_restored),
        cmocka_unit_test(division_by_zero_ends_the_process),
        cmocka_unit_test(driver_has_the_given_number_of_threads),
        cmocka_unit_test(driver_leaves_signals_alone),
    };

    if (argc == 2)
        return run_child(argv[1]);
    return cmocka_run_group_tests_name("cl_environment", tests, make_folder,
                                       remove_folder);
}
