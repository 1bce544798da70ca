/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats over time: finds the reader of a source. */
#include "config.h"

#include "media/arrays/zip_read.h"
#include "media/dynamic/dynamic_readers.h"
#include "media/dynamic/motion.h"
#include "media/dynamic/splat_files.h"
#include "system/file.h"
#include "system/paths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FILE_MAX ((uint64_t)8 << 30) /* bytes of a file that is read; chosen by hand, not measured */

static const adcgs_dynamic_reader *const readers[] = {ADCGS_DYNAMIC_READERS};

/** The first bytes decide; all bytes of an archive, whose directory is at its end, if they do not. */
static const adcgs_dynamic_reader *find_reader(const uint8_t *data, size_t bytes)
{
    for (int pass = 0; pass < (bytes > ADCGS_DYNAMIC_LOOK && adcgs_zip_is(data, bytes) ? 2 : 1); pass++)
        for (size_t i = 0; i < ADCGS_COUNTOF(readers); i++)
            if (readers[i]->is(data, pass ? bytes : ADCGS_MIN(bytes, ADCGS_DYNAMIC_LOOK)))
                return readers[i];
    return NULL;
}

int adcgs_dynamic_is(const char *path)
{
    FILE *file;
    if (adcgs_is_folder(path))
        return adcgs_splat_files_are(path);
    if (adcgs_file_open(&file, path, NULL) != ADCGS_OK)
        return 0;
    uint8_t *data = calloc(1, ADCGS_DYNAMIC_LOOK + 1);
    size_t n = data ? fread(data, 1, ADCGS_DYNAMIC_LOOK, file) : 0;
    int found = n && find_reader(data, n);
    if (n == ADCGS_DYNAMIC_LOOK && !found && adcgs_zip_is(data, n)) {
        free(data);
        rewind(file);
        found = adcgs_file_load_open(&data, &n, file, path, FILE_MAX, NULL) == ADCGS_OK && find_reader(data, n);
    }
    fclose(file);
    free(data);
    return found;
}

static void forget(adcgs_dynamic *m)
{
    free((void *)(uintptr_t)m->data);
    m->data = NULL;
}

/** Takes data from malloc(), also on failure. reader: NULL if there is none. */
static adcgs_status open_data(adcgs_dynamic **out, const adcgs_dynamic_reader *reader, uint8_t *data, size_t bytes,
                              const char *path, const adcgs_dynamic_options *options, adcgs_error *error)
{
    static const adcgs_dynamic_options defaults;
    adcgs_dynamic *m = reader ? calloc(1, sizeof *m) : NULL;
    char *const name = strdup(path);
    *out = NULL;
    if (!m || !name) {
        free(m);
        free(name);
        free(data);
        return reader ? adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path)
                      : adcgs_fail(error, ADCGS_ERR_DATA, "%s: not splats over time", path);
    }
    *m = (adcgs_dynamic){.reader = reader, .path = name, .options = options ? *options : defaults, .data = data, .bytes = bytes};
    const adcgs_status status = reader->open(m, error);
    if (status != ADCGS_OK)
        adcgs_dynamic_free(&m);
    else if (!reader->keeps_data)
        forget(m);
    *out = m;
    return status;
}

adcgs_status adcgs_dynamic_open(adcgs_dynamic **out, const char *path, const adcgs_dynamic_options *options, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    *out = NULL;
    if (adcgs_is_folder(path))
        return open_data(out, &adcgs_dynamic_files, NULL, 0, path, options, error);
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    return open_data(out, find_reader(data, bytes), data, bytes, path, options, error);
}

adcgs_status adcgs_dynamic_parse(adcgs_dynamic **out, const uint8_t *data, size_t bytes, const char *path,
                                 const adcgs_dynamic_options *options, adcgs_error *error)
{
    uint8_t *const copy = calloc(1, bytes + 1);
    *out = NULL;
    if (!copy)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    memcpy(copy, data, bytes);
    return open_data(out, find_reader(copy, bytes), copy, bytes, path, options, error);
}

double adcgs_dynamic_duration(const adcgs_dynamic *m)
{
    return (m->frames - 1.0) * m->rate.den / m->rate.num;
}

adcgs_status adcgs_dynamic_at(const adcgs_dynamic *m, double seconds, adcgs_splats *out, adcgs_error *error)
{
    *out = (adcgs_splats){0};
    const adcgs_status status = m->reader->at(m, fmin(fmax(seconds, 0.0), adcgs_dynamic_duration(m)), out, error);
    if (status != ADCGS_OK)
        adcgs_splats_free(out);
    return status;
}

const char *adcgs_dynamic_path(const adcgs_dynamic *m, uint32_t i)
{
    return m->reader == &adcgs_dynamic_files ? adcgs_splat_files_path(m, i) : i ? NULL : m->path;
}

void adcgs_dynamic_free(adcgs_dynamic **dynamic)
{
    adcgs_dynamic *const m = *dynamic;
    if (m) {
        m->reader->close(m);
        forget(m);
        free(m->path);
        free(m);
    }
    *dynamic = NULL;
}
