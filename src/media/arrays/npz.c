/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Arrays in NPZ files: the files of a ZIP archive whose names end in ".npy". */
#include "config.h"

#include "media/arrays/npz.h"

#include "media/arrays/zip_read.h"
#include "system/file.h"

#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define FILE_MAX ((uint64_t)4 << 30) /* bytes of an archive */
#define NAME_MAX_BYTES 256           /* bytes of an array's name and its ending */

adcgs_status adcgs_npz_parse(uint8_t **out, size_t *bytes, const uint8_t *archive, size_t archive_bytes, const char *path,
                             const char *array, adcgs_error *error)
{
    char name[NAME_MAX_BYTES];
    adcgs_zip_archive zip;
    *out = NULL;
    ADCGS_TRY(adcgs_zip_open(&zip, archive, archive_bytes, path, error));
    snprintf(name, sizeof name, "%s.npy", array);
    if (!adcgs_zip_has(&zip, name))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no array %s in the file", path, array);
    return adcgs_zip_unpack(out, bytes, &zip, name, FILE_MAX, error);
}

adcgs_status adcgs_npz_read(uint8_t **out, size_t *bytes, const char *path, const char *array, adcgs_error *error)
{
    uint8_t *archive;
    size_t archive_bytes;
    *out = NULL;
    ADCGS_TRY(adcgs_file_load(&archive, &archive_bytes, path, FILE_MAX, error));
    const adcgs_status status = adcgs_npz_parse(out, bytes, archive, archive_bytes, path, array, error);
    free(archive);
    return status;
}
