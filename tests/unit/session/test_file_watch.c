// SPDX-License-Identifier: MIT
/*
 * test_file_watch.c - files that change as editors change them: in place, by
 * rename, through links, from nothing; and other events, which are no changes
 */
#include "tests/unit/check.h"
#include "tests/unit/files.h"

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "session/file_watch.h"

static char paths[4][256];

enum { PLAIN, OTHER, LINK, TARGET };

/* Makes link -> below/target and plain; other does not exist. */
static void begin(struct file_watch *w)
{
    static const char *const names[] = {"plain", "other", "link",
                                        "below/target"};
    char below[256];

    snprintf(below, sizeof below, "%s/below", folder);
    mkdir(below, 0700);
    for (int i = 0; i < 4; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/%s", folder, names[i]);
        unlink(paths[i]);
    }
    put(paths[PLAIN], "one");
    put(paths[TARGET], "one");
    assert_int_equal(symlink("below/target", paths[LINK]), 0);
    file_watch_init(w);
    file_watch_begin(w);
    for (int i = PLAIN; i <= LINK; i++)
        file_watch_add(w, paths[i]);
    file_watch_end(w);
    assert_true(w->fd >= 0);
}

/* Returns whether fd is readable, and empties it. */
static bool is_told(struct file_watch *w)
{
    struct pollfd fd = {.fd = w->fd, .events = POLLIN};
    bool is = poll(&fd, 1, 2000) == 1;

    file_watch_drain(w);
    assert_int_equal(poll(&fd, 1, 0), 0);
    return is;
}

static void unchanged_files_are_no_change(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    assert_false(file_watch_has_changed(&w));
    file_watch_free(&w);
}

static void writing_in_place_is_noticed(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    put(paths[PLAIN], "three");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_settle(&w);
    assert_false(file_watch_has_changed(&w));
    put(paths[PLAIN], "three, and more");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_settle(&w);
    assert_false(file_watch_has_changed(&w));
    file_watch_free(&w);
}

/* Writes of this program are not changes, unlike writes of others before or
 * after them. */
static void files_are_known_by_any_name(void **state)
{
    struct file_watch w;
    char other_way[256];

    (void)state;
    begin(&w);
    snprintf(other_way, sizeof other_way, "%s/below/../plain", folder);
    assert_true(file_watch_has(&w, paths[PLAIN]));
    assert_true(file_watch_has(&w, other_way));
    assert_true(
        file_watch_has(&w, paths[TARGET])); /* the link is in the list */
    /* In the list, but absent. */
    assert_false(file_watch_has(&w, paths[OTHER]));
    snprintf(other_way, sizeof other_way, "%s/same", folder);
    put(other_way, "one");
    assert_false(file_watch_has(&w, other_way));
    unlink(other_way);
    file_watch_free(&w);
}

static void own_writes_are_no_change(void **state)
{
    struct file_change change;
    struct error err;
    struct file_watch w;

    (void)state;
    begin(&w);
    change.before = file_identify(paths[PLAIN]);
    assert_true(file_replace(paths[PLAIN], "own", 3, &change, &err));
    assert_true(file_watch_has_changed(&w));
    file_watch_replaced(&w, paths[LINK], &change); /* another version */
    assert_true(file_watch_has_changed(&w));
    file_watch_replaced(&w, paths[PLAIN], &change);
    assert_false(file_watch_has_changed(&w));
    put(paths[PLAIN], "theirs");
    assert_true(file_watch_has_changed(&w));
    change.before = file_identify(paths[PLAIN]);
    assert_true(file_replace(paths[PLAIN], "own", 3, &change, &err));
    file_watch_replaced(&w, paths[PLAIN], &change);
    /* The other version was not loaded. */
    assert_true(file_watch_has_changed(&w));
    file_watch_wrote(&w, paths[PLAIN], &change.after);
    assert_false(file_watch_has_changed(&w));
    unlink(paths[PLAIN]); /* nothing of the other version is left */
    change.before = file_identify(paths[PLAIN]);
    assert_true(file_replace(paths[PLAIN], "again", 5, &change, &err));
    file_watch_replaced(&w, paths[PLAIN], &change);
    assert_false(file_watch_has_changed(&w));
    file_watch_free(&w);
}

static void renaming_over_is_noticed(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    put(paths[OTHER], "one"); /* it is in the list itself */
    file_watch_settle(&w);
    file_watch_drain(&w);
    assert_int_equal(rename(paths[OTHER], paths[PLAIN]), 0);
    assert_true(is_told(&w));
    assert_false(file_watch_has_changed(&w)); /* until all files exist again */
    put(paths[OTHER], "one");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_free(&w);
}

static void new_files_are_noticed(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    put(paths[OTHER], "new");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_free(&w);
}

static void targets_of_links_are_noticed(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    put(paths[TARGET], "three");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_free(&w);
}

/* vim moves the old file away, writes a new one and removes the old one. */
static void absent_files_are_waited_for(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    unlink(paths[PLAIN]);
    assert_false(file_watch_has_changed(&w));
    file_watch_settle(&w);
    /* A list without the file, which could not be loaded. */
    file_watch_begin(&w);
    file_watch_add(&w, paths[LINK]);
    file_watch_end(&w);
    put(paths[PLAIN], "one again");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_begin(&w); /* the file exists, but is not in a list */
    file_watch_add(&w, paths[LINK]);
    file_watch_end(&w);
    assert_false(file_watch_has_changed(&w));
    assert_int_equal(w.file_count, 1);
    file_watch_free(&w);
}

static void pause_ms(int ms)
{
    poll(NULL, 0, ms);
}

/* A file that stays away is a change, and later changes of others are. */
static void removed_files_are_noticed_after_a_second(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    unlink(paths[PLAIN]);
    put(paths[TARGET], "three");
    assert_true(is_told(&w));
    assert_false(file_watch_has_changed(&w));
    assert_true(w.is_changing);
    pause_ms(1100);
    assert_true(file_watch_has_changed(&w));
    assert_false(w.is_changing);
    file_watch_settle(&w); /* it is loaded, and names the file no more */
    file_watch_begin(&w);
    file_watch_add(&w, paths[LINK]);
    file_watch_end(&w);
    assert_false(file_watch_has_changed(&w));
    put(paths[TARGET], "three, and more");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    file_watch_free(&w);
}

/* An export that takes a while between its writes. */
static void files_are_waited_for_until_they_are_closed(void **state)
{
    struct file_watch w;
    FILE *f;

    (void)state;
    begin(&w);
    f = fopen(paths[PLAIN], "w");
    assert_non_null(f);
    for (int i = 0; i < 3; i++) {
        fputs("a part", f);
        fflush(f);
        assert_true(is_told(&w));
        assert_false(file_watch_has_changed(&w));
        pause_ms(300);
        assert_false(file_watch_has_changed(&w));
        assert_true(w.is_changing);
    }
    fclose(f);
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    assert_false(w.is_changing);
    file_watch_free(&w);
}

/* git removes a file and writes it anew. */
static void files_that_come_back_are_one_change(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    unlink(paths[PLAIN]);
    assert_true(is_told(&w));
    assert_false(file_watch_has_changed(&w));
    put(paths[PLAIN], "from another branch");
    assert_true(is_told(&w));
    assert_true(file_watch_has_changed(&w));
    assert_true(w.is_changing); /* since the last look */
    assert_true(file_watch_has_changed(&w));
    assert_false(w.is_changing);
    file_watch_free(&w);
}

/* A new list keeps what is known about the files. */
static void lists_keep_what_is_known(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    put(paths[PLAIN], "three");
    file_watch_begin(&w);
    file_watch_add(&w, paths[PLAIN]);
    file_watch_end(&w);
    assert_true(file_watch_has_changed(&w));
    file_watch_free(&w);
}

static void other_files_are_no_change(void **state)
{
    struct file_watch w;

    (void)state;
    begin(&w);
    snprintf(paths[OTHER], sizeof paths[OTHER], "%s/picture.png", folder);
    put(paths[OTHER], "not ours");
    assert_false(file_watch_has_changed(&w));
    unlink(paths[OTHER]);
    file_watch_free(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unchanged_files_are_no_change),
        cmocka_unit_test(writing_in_place_is_noticed),
        cmocka_unit_test(files_are_known_by_any_name),
        cmocka_unit_test(own_writes_are_no_change),
        cmocka_unit_test(renaming_over_is_noticed),
        cmocka_unit_test(new_files_are_noticed),
        cmocka_unit_test(targets_of_links_are_noticed),
        cmocka_unit_test(absent_files_are_waited_for),
        cmocka_unit_test(removed_files_are_noticed_after_a_second),
        cmocka_unit_test(files_are_waited_for_until_they_are_closed),
        cmocka_unit_test(files_that_come_back_are_one_change),
        cmocka_unit_test(lists_keep_what_is_known),
        cmocka_unit_test(other_files_are_no_change),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
