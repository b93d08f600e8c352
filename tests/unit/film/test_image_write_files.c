// SPDX-License-Identifier: MIT
/*
 * test_image_write_files.c - where pictures are written: paths, numbers,
 * standard output, and what a killed process or a full disk leaves
 */
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/unit/files.h"
#include "tests/unit/film/written_films.h"

/* Everybody may write into the folder, since a test gives up the rights of
 * root. */
static int enter(void **state)
{
    return enter_folder(state) == 0 ? chmod(folder, 0777) : -1;
}

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static float dark(int x, int y, int c)
{
    (void)x, (void)y, (void)c;
    return 0;
}

static void paths_that_cannot_be_written_are_refused(void **state)
{
    static const struct {
        const char *path, *expected;
    } cases[] = {
        {"a.jpg",
         "a.jpg: found no known ending, expected .png, .hdr, .pfm or .exr"},
        {"", ": found no known ending, expected .png, .hdr, .pfm or .exr"},
        {".", ".: found a folder, expected a file"},
        {"d.png", "d.png: found a folder, expected a file"},
        {"no/a.png", "no: no such file or folder"},
        {"p.png", "p.png: found a pipe, expected a file"},
    };
    struct error err;

    (void)state;
    mkdir("d.png", 0777);
    assert_int_equal(mkfifo("p.png", 0666), 0);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_false(image_write_check(cases[i].path, &err));
        assert_string_equal(err.text, cases[i].expected);
    }
    assert_true(image_write_check("new.png", &err));
    assert_false(exists("new.png"));
}

static void pictures_are_not_written_to_terminals(void **state)
{
    int saved = dup(STDOUT_FILENO);
    int terminal = posix_openpt(O_RDWR | O_NOCTTY);
    struct error err = {""};

    (void)state;
    assert_true(saved >= 0);
    if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0)
        skip();
    int other = open(ptsname(terminal), O_RDWR | O_NOCTTY);
    assert_true(other >= 0);
    fflush(stdout);
    dup2(other, STDOUT_FILENO);
    bool on_terminal = image_write_check("-", &err);
    int pipe_ends[2];
    assert_int_equal(pipe(pipe_ends), 0);
    dup2(pipe_ends[1], STDOUT_FILENO);
    bool on_pipe = image_write_check("-", &(struct error){""});
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(other);
    close(terminal);
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    assert_false(on_terminal);
    assert_non_null(strstr(err.text, "give -o FILE"));
    assert_true(on_pipe);
}

/* Writes the film to standard output, which is a pipe. The reader takes all of
 * it, or closes the pipe at once. */
static bool write_to_pipe(struct film *film, bool reads, struct error *err)
{
    int ends[2], saved = dup(STDOUT_FILENO), status;

    fflush(stdout);
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        char bytes[1000];
        FILE *f = fopen("piped.png", "wb");
        ssize_t n;
        close(ends[1]);
        while (reads && f && (n = read(ends[0], bytes, sizeof bytes)) > 0)
            fwrite(bytes, 1, (size_t)n, f);
        if (f)
            fclose(f);
        _exit(0);
    }
    close(ends[0]);
    fcntl(ends[1], F_SETFL, O_NONBLOCK);
    dup2(ends[1], STDOUT_FILENO);
    close(ends[1]);
    if (!reads)
        waitpid(child, &status, 0);
    bool ok = image_write(film, develop_linear(0), NULL, "-", err);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    if (reads)
        waitpid(child, &status, 0);
    return ok;
}

static float noise(int x, int y, int c)
{
    uint32_t h = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^
                 (uint32_t)c * 83492791u;

    h = (h ^ (h >> 13)) * 0x5bd1e995u;
    return (float)(h >> 8) * 0x1p-24f;
}

static void standard_output_has_the_picture(void **state)
{
    struct film film;
    struct frame frame;
    struct error err;

    (void)state;
    signal(SIGPIPE, SIG_IGN);
    make_film(&film, 300, 200, noise); /* more than a pipe buffers */
    assert_true(write_to_pipe(&film, true, &err));
    assert_true(frame_init(&frame, 300, 200, &err));
    film_resolve(&film, develop_linear(0), &frame);
    has_bytes("piped.png", &frame);
    assert_false(write_to_pipe(&film, false, &err));
    assert_string_equal(err.text, "standard output: Broken pipe");
    frame_free(&frame);
    film_free(&film);
}

static void numbered_pictures_take_the_first_free_name(void **state)
{
    static const char *const expected[] = {"n.png", "n-2.png", "n-4.png",
                                           "n-6.png"};
    struct film film;
    struct error err;
    struct stat st;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, light);
    fclose(fopen("n-3.png", "w"));
    assert_int_equal(symlink("nowhere", "n-5.png"), 0);
    for (int i = 0; i < 4; i++) {
        char *path = image_write_numbered(&film, develop_linear(0), NULL, "n",
                                          "png", &err);
        assert_non_null(path);
        assert_string_equal(path, expected[i]);
        assert_int_equal(stat(path, &st), 0);
        assert_true(st.st_size > 100);
        free(path);
    }
    assert_int_equal(stat("n-3.png", &st), 0);
    assert_int_equal(st.st_size, 0);
    assert_false(exists("nowhere"));
    assert_null(image_write_numbered(&film, develop_linear(0), NULL, "no/n",
                                     "png", &err));
    assert_string_equal(err.text, "no/n.png: no such file or folder");
    film_free(&film);
}

/* Processes that write at the same time never take the same name. */
static void numbered_names_are_never_taken_twice(void **state)
{
    struct film film;
    pid_t children[4];
    char path[32];

    (void)state;
    make_film(&film, 8, 8, light);
    for (int i = 0; i < 4; i++) {
        children[i] = fork();
        if (children[i] == 0) {
            struct error err;
            int written = 0;
            for (int k = 0; k < 10; k++) {
                char *name = image_write_numbered(&film, develop_linear(0),
                                                  NULL, "race", "png", &err);
                written += name != NULL;
                free(name);
            }
            _exit(written);
        }
    }
    for (int i = 0; i < 4; i++) {
        int status;
        waitpid(children[i], &status, 0);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 10);
    }
    for (int i = 2; i <= 40; i++) {
        snprintf(path, sizeof path, "race-%d.png", i);
        assert_true(exists(path));
    }
    assert_false(exists("race-41.png"));
    film_free(&film);
}

static void write_forever(struct film *a, struct film *b)
{
    struct error err;

    for (;;) {
        if (!image_write(a, develop_linear(0), NULL, "k.png", &err) ||
            !image_write(b, develop_linear(0), NULL, "k.png", &err))
            _exit(1);
    }
}

/* When the writer is killed at any moment, the file is one of the two
 * pictures. */
static void killed_writers_leave_a_whole_picture(void **state)
{
    struct film films[2];
    size_t sizes[2], size;
    char *files[2];
    struct error err;
    uint64_t random = 7;

    (void)state;
    make_film(&films[0], 160, 120, noise);
    make_film(&films[1], 160, 120, dark);
    for (int i = 0; i < 2; i++) {
        assert_true(
            image_write(&films[i], develop_linear(0), NULL, "k.png", &err));
        files[i] = read_file("k.png", &size);
        sizes[i] = size;
    }
    int found[2] = {0};
    for (int i = 0; i < 60; i++) {
        int status;
        pid_t child = fork();
        if (child == 0)
            write_forever(&films[0], &films[1]);
        usleep((useconds_t)(check_random(&random) * 40000));
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        assert_true(WIFSIGNALED(status));
        char *text = read_file("k.png", &size);
        int which = size == sizes[0] ? 0 : 1;
        assert_int_equal(size, sizes[which]);
        assert_memory_equal(text, files[which], size);
        found[which]++;
        free(text);
    }
    print_message("%d times the one picture, %d times the other\n", found[0],
                  found[1]);
    for (int i = 0; i < 2; i++) {
        free(files[i]);
        film_free(&films[i]);
    }
}

/* Runs in a child process, since the limit cannot be removed. */
static bool fails_on_full_disk(struct film *film)
{
    static const char *const paths[] = {"f.png", "f.hdr", "f.pfm", "f.exr"};
    struct rlimit limit = {1024, 1024};
    struct error err;
    bool ok = true;

    signal(SIGXFSZ, SIG_IGN);
    ok = setrlimit(RLIMIT_FSIZE, &limit) == 0;
    for (int i = 0; i < 4; i++)
        ok = ok &&
             !image_write(film, develop_linear(0), NULL, paths[i], &err) &&
             strstr(err.text, ": File too large") &&
             strncmp(err.text, paths[i], 5) == 0;
    return ok && !image_write_numbered(film, develop_linear(0), NULL, "full",
                                       "png", &err);
}

static void full_disk_keeps_the_old_picture(void **state)
{
    struct film film;
    struct error err;
    int status;

    (void)state;
    make_film(&film, WIDTH, HEIGHT, noise);
    FILE *f = fopen("f.png", "w");
    assert_non_null(f);
    fputs("old", f);
    fclose(f);
    pid_t child = fork();
    if (child == 0)
        _exit(fails_on_full_disk(&film) ? 0 : 1);
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    size_t size;
    char *text = read_file("f.png", &size);
    assert_string_equal(text, "old");
    free(text);
    assert_false(exists("f.hdr") || exists("f.pfm") || exists("f.exr") ||
                 exists("full.png"));

    int saved = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY);
    fflush(stdout);
    dup2(full, STDOUT_FILENO);
    bool ok = image_write(&film, develop_linear(0), NULL, "-", &err);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(full);
    assert_false(ok);
    assert_string_equal(err.text, "standard output: No space left on device");
    film_free(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_that_cannot_be_written_are_refused),
        cmocka_unit_test(pictures_are_not_written_to_terminals),
        cmocka_unit_test(standard_output_has_the_picture),
        cmocka_unit_test(numbered_pictures_take_the_first_free_name),
        cmocka_unit_test(numbered_names_are_never_taken_twice),
        cmocka_unit_test(killed_writers_leave_a_whole_picture),
        cmocka_unit_test(full_disk_keeps_the_old_picture),
    };

    return cmocka_run_group_tests(tests, enter, remove_folder);
}
