/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A separate folder for each test program, and small files in it; data sets outside the tree. */
#ifndef ADCGS_TESTS_OUTSIDE_FILES_H
#define ADCGS_TESTS_OUTSIDE_FILES_H

#include "config.h" /* for the declarations that it enables in system headers */

#include "base/base.h"

#include <dirent.h>
#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[256];
static adcgs_error error;

/** Path of a file in the folder; the text lives until the fourth call after this one. */
static inline const char *in(const char *name)
{
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/** Path of a file in the folder that ADCGS_DATA names; the test is skipped without it. Lives for two calls. */
static inline const char *real_data(const char *name)
{
    static char paths[2][1024];
    static int next;
    char *path = paths[next++ % 2];
    const char *data = getenv("ADCGS_DATA");
    snprintf(path, sizeof paths[0], "%s/%s", data ? data : "", name);
    if (!data || access(path, R_OK)) {
        print_message("skipped: no ADCGS_DATA/%s\n", name);
        skip();
    }
    return path;
}

static inline int make_folder(void **state)
{
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/adcgs-test-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    return remove(path);
}

static inline int remove_folder(void **state)
{
    return nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

static inline int count_files(void)
{
    int n = 0;
    DIR *directory = opendir(folder);
    while (directory && readdir(directory))
        n++;
    if (directory)
        closedir(directory);
    return n - 2;
}

static inline void put_bytes(const char *name, const void *data, size_t bytes)
{
    FILE *file = fopen(in(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

static inline void put_text(const char *name, const char *text)
{
    put_bytes(name, text, strlen(text));
}

/** The message is one line with both parts. */
static inline void expect_error(adcgs_status got, adcgs_status expected, const char *first, const char *second)
{
    if (got != expected || !strstr(error.text, first) || !strstr(error.text, second))
        fail_msg("status %d, text \"%s\"; expected %d with \"%s\" and \"%s\"", got, error.text, expected, first, second);
    assert_int_equal(error.status, expected);
    assert_null(strchr(error.text, '\n'));
}

#endif
