// SPDX-License-Identifier: MIT
/* test_thread.c - signals that reach a thread, and those that only the main
 * thread gets */
#include <sched.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/thread_pool.h"
#include "tests/unit/check.h"

#define HANDLED 7

static void on_fault(int number)
{
    (void)number;
    _exit(HANDLED);
}

static void *raise_fault(void *number)
{
    raise(*(int *)number);
    return NULL;
}

/* Returns the wait status of a process in which a thread raises this fault. */
static int status_after(int number)
{
    pid_t child = fork();
    int status;

    if (child == 0) {
        pthread_t thread;

        signal(number, on_fault);
        if (thread_start(&thread, raise_fault, &number) == 0)
            pthread_join(thread, NULL);
        _exit(0);
    }
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    return status;
}

static void faults_of_threads_reach_their_handler(void **state)
{
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        int status = status_after(faults[i]);

        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == HANDLED);
    }
}

static void *read_mask(void *mask)
{
    pthread_sigmask(SIG_SETMASK, NULL, mask);
    return NULL;
}

static void other_signals_reach_only_the_main_thread(void **state)
{
    static const int others[] = {SIGINT,  SIGTERM, SIGHUP,
                                 SIGTSTP, SIGCONT, SIGWINCH};
    sigset_t mask, before, after;
    pthread_t thread;

    (void)state;
    pthread_sigmask(SIG_SETMASK, NULL, &before);
    assert_int_equal(thread_start(&thread, read_mask, &mask), 0);
    pthread_join(thread, NULL);
    pthread_sigmask(SIG_SETMASK, NULL, &after);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        assert_true(sigismember(&mask, others[i]));
        assert_int_equal(sigismember(&before, others[i]),
                         sigismember(&after, others[i]));
    }
}

static void usable_threads_follow_the_affinity_mask(void **state)
{
    cpu_set_t mask, one;

    (void)state;
    assert_int_equal(sched_getaffinity(0, sizeof mask, &mask), 0);
    int all = usable_threads();
    assert_in_range(all, 1, CPU_COUNT(&mask));
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; i++) {
        if (CPU_ISSET(i, &mask))
            CPU_SET(i, &one);
    }
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    int single = usable_threads();
    sched_setaffinity(0, sizeof mask, &mask);
    assert_int_equal(single, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faults_of_threads_reach_their_handler),
        cmocka_unit_test(other_signals_reach_only_the_main_thread),
        cmocka_unit_test(usable_threads_follow_the_affinity_mask),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
