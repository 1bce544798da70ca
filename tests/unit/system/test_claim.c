/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Claims: the owner is determined by processes where these can be queried, not by clocks, which may be wrong. */
#define BEAT 1            /* second */
#include "system/claim.c" /* before any global name of the test can be shadowed */

#include "outside_files.h"

#include <sys/wait.h>

static const char *path;

/** Shifts the time of the claim. */
static void set_age(double seconds)
{
    struct timespec times[2];
    clock_gettime(CLOCK_REALTIME, &times[0]);
    times[0].tv_sec -= (time_t)seconds;
    times[1] = times[0];
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static void put_claim(const char *text, double age)
{
    FILE *const file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    set_age(age);
}

static void expect_refused(long process)
{
    char text[32];
    adcgs_claim *claim;
    snprintf(text, sizeof text, "process %ld on ", process);
    assert_int_equal(adcgs_claim_take(&claim, path, "this", &error), ADCGS_ERR_IO);
    assert_null(claim);
    assert_non_null(strstr(error.text, text));
    assert_int_equal(adcgs_claim_absent(path, "this", &error), ADCGS_ERR_IO);
}

static void expect_taken(void)
{
    adcgs_claim *claim;
    if (adcgs_claim_take(&claim, path, "this", &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(adcgs_claim_check(claim, &error), ADCGS_OK);
    adcgs_claim_drop(&claim);
    assert_int_equal(access(path, F_OK), -1);
}

/** A process that has the claim, and then sleeps. */
static pid_t begin_owner(void)
{
    int ready[2];
    char byte;
    assert_int_equal(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        adcgs_claim *claim;
        if (adcgs_claim_take(&claim, path, "this", &error) == ADCGS_OK && write(ready[1], "+", 1) == 1)
            for (;;)
                pause();
        _exit(1);
    }
    close(ready[1]);
    assert_int_equal(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    return child;
}

/** On one machine a running owner keeps its claim, and an ended one loses it, at any file time. */
static void processes_are_believed(void **state)
{
    static const double ages[] = {0, 600, -3600};
    const pid_t child = begin_owner();
    (void)state;
    kill(child, SIGSTOP); /* no beats */
    for (size_t i = 0; i < ADCGS_COUNTOF(ages); i++) {
        set_age(ages[i]);
        expect_refused((long)child);
    }
    kill(child, SIGKILL);
    siginfo_t info;
    assert_int_equal(waitid(P_PID, (id_t)child, &info, WEXITED | WNOWAIT), 0); /* its number is still in use */
    set_age(0);
    expect_taken();
    assert_int_equal(waitpid(child, NULL, 0), child);
}

/** A process number that was reused by another process. */
static void numbers_are_given_again(void **state)
{
    char text[TEXT_MAX];
    owner own;
    find_own(&own);
    (void)state;
    if (!own.began) {
        print_message("skipped: /proc does not give start times of processes\n");
        skip();
    }
    const long other = (long)getppid();
    snprintf(text, sizeof text, "%s %ld %s %s %llu\n", own.host, other, own.since, own.place, find_begin(other) + 1);
    put_claim(text, 0);
    expect_taken();
    snprintf(text, sizeof text, "%s %ld %s %s %llu\n", own.host, other, own.since, own.place, find_begin(other));
    put_claim(text, 600);
    expect_refused(other);
    unlink(path);
}

static void *touch_often(void *argument)
{
    const struct timespec nap = {.tv_nsec = 100000000};
    const int *const ends = argument;
    while (!*(const volatile int *)ends) {
        nanosleep(&nap, NULL);
        set_age(600); /* of a file system whose clock is ten minutes late, or was set forward */
    }
    return NULL;
}

/** For an owner on another machine, only the file's time and its changes count. */
static void times_that_go_on_are_believed(void **state)
{
    static const double ages[] = {600, -3600};
    pthread_t thread;
    int ends = 0;
    (void)state;
    put_claim("elsewhere 1 2026-01-01T00:00:00Z there 1\n", 0);
    expect_refused(1);
    assert_int_equal(pthread_create(&thread, NULL, touch_often, &ends), 0);
    set_age(600);
    expect_refused(1);
    *(volatile int *)&ends = 1;
    pthread_join(thread, NULL);
    for (size_t i = 0; i < ADCGS_COUNTOF(ages); i++) {
        put_claim("elsewhere 1 2026-01-01T00:00:00Z there 1\n", ages[i]);
        expect_taken();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(processes_are_believed),
        cmocka_unit_test(numbers_are_given_again),
        cmocka_unit_test(times_that_go_on_are_believed),
    };
    if (make_folder(NULL))
        return 99;
    path = strdup(in("x.claim"));
    const int failures = cmocka_run_group_tests_name("claim", tests, NULL, NULL);
    remove_folder(NULL);
    return failures;
}
