/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Output of a live stream. */
#include "config.h"

#include "session/enc_live_file.h"

#include "encode/settle.h"
#include "system/pipe.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

#define NUMBER_MAX 9999 /* most consecutive streams; definition: four digits of a name */

/** Returns the name of a stream's file, from malloc(): the number goes before the extension. */
static char *number_name(const char *name, uint32_t number)
{
    const size_t n = strlen(name) + 16;
    const char *const slash = strrchr(name, '/'), *dot = strrchr(slash ? slash : name, '.');
    char *path = malloc(n);
    if (!dot || dot == name || dot[-1] == '/')
        dot = name + strlen(name);
    if (path && number > 1 && strcmp(name, "-") != 0)
        snprintf(path, n, "%.*s.%u%s", (int)(dot - name), name, number, dot);
    else if (path)
        memcpy(path, name, strlen(name) + 1);
    return path;
}

static adcgs_status open_number(adcgs_enc_live_file *f, uint32_t number, adcgs_error *error)
{
    f->number = number;
    f->path = number_name(f->name, number);
    return f->path ? adcgs_growing_open(&f->growing, f->path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
}

/** Returns the number of the stream with this name; 0: none. */
static uint32_t find_number(const char *name, const char *past)
{
    for (uint32_t number = 1; number <= NUMBER_MAX; number++) {
        char *const path = number_name(name, number);
        const int is_it = path && !strcmp(path, past);
        free(path);
        if (is_it)
            return number;
    }
    return 0;
}

/** True if another stream follows. */
static int follows(const char *name, uint32_t number)
{
    char *const path = number_name(name, number + 1);
    const int is_there = path && !access(path, F_OK);
    free(path);
    return is_there;
}

adcgs_status adcgs_enc_live_file_open(adcgs_enc_live_file *f, const char *name, const char *past, adcgs_error *error)
{
    *f = (adcgs_enc_live_file){.name = name};
    if (past && adcgs_pipe_is(past))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--resume %s: expected a file, which can be read back", past);
    const uint32_t number = past ? find_number(name, past) : 1;
    if (!number)
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "--resume %s: expected the file of --output, or a later one "
                          "(name.2.adcgs)",
                          past);
    if (past && follows(name, number))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--resume %s: another stream followed, number %u: continue the last one", past,
                          number + 1);
    ADCGS_TRY(open_number(f, number, error));
    f->growing.is_hidden = past != NULL;
    return ADCGS_OK;
}

adcgs_status adcgs_enc_live_file_append(adcgs_enc_live_file *f, const void *data, size_t bytes, adcgs_error *error)
{
    return adcgs_growing_append(&f->growing, data, bytes, error);
}

/** Replaces the grown stream by the same stream with another HEAD. */
static adcgs_status settle(const char *path, const adcgs_buffer *head, adcgs_error *error)
{
    adcgs_atomic to;
    FILE *from = fopen(path, "rb");
    if (!from)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read it back: %s", path, strerror(errno));
    adcgs_status status = adcgs_atomic_open(&to, path, error);
    if (status == ADCGS_OK)
        status = adcgs_encode_replace_head(to.file, from, head->data, head->size, path, error);
    fclose(from);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&to, error);
    adcgs_atomic_abort(&to);
    return status;
}

adcgs_status adcgs_enc_live_file_end(adcgs_enc_live_file *f, const adcgs_buffer *head, adcgs_error *error)
{
    const int is_regular = f->growing.is_regular;
    if (!is_regular)
        return ADCGS_OK;
    adcgs_growing_close(&f->growing);
    return settle(f->path, head, error);
}

adcgs_status adcgs_enc_live_file_next(adcgs_enc_live_file *f, adcgs_error *error)
{
    if (!f->growing.is_regular)
        return ADCGS_OK;
    free(f->path);
    f->path = NULL;
    return open_number(f, f->number + 1, error);
}

void adcgs_enc_live_file_close(adcgs_enc_live_file *f)
{
    adcgs_growing_close(&f->growing);
    free(f->path);
    f->path = NULL;
}
