// SPDX-License-Identifier: MIT
/*
 * thread.h - threads that leave signals to the main one, and how many to start
 *
 * Ownership: the thread is the caller's to join
 * Threads:   any
 * Errors:    those of pthread_create()
 */
#ifndef GLIM_THREAD_H
#define GLIM_THREAD_H

#include <pthread.h>

/* Starts run(argument) with all signals blocked: a worker that took SIGWINCH
 * would leave the main thread waiting for the next key. Only those of a fault
 * of its own reach it, for the handler that gives the terminal back. 0, or what
 * is wrong as errno has it. */
int thread_start(pthread_t *thread, void *(*run)(void *), void *argument);

/* Threads that this process may use: its affinity mask and its cgroup's quota,
 * at least 1. */
int usable_threads(void);

#endif
