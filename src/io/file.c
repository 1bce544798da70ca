/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A whole file in memory. */
#include "config.h"

#include "io/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

adcgs_status adcgs_file_load(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error)
{
    *data = NULL;
    *bytes = 0;
    FILE *file = fopen(path, "rb");
    struct stat status;
    if (!file || fstat(fileno(file), &status)) {
        const int reason = errno;
        if (file)
            fclose(file);
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(reason));
    }
    adcgs_status result = ADCGS_OK;
    const uint64_t size = (uint64_t)status.st_size;
    uint8_t *buffer = NULL;
    if (!S_ISREG(status.st_mode))
        result = adcgs_fail(error, ADCGS_ERR_IO, "%s: not a regular file", path);
    else if (size > limit || size >= SIZE_MAX)
        result = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu bytes, expected at most %llu", path, (unsigned long long)size,
                            (unsigned long long)limit);
    else if (!(buffer = malloc((size_t)size + 1)))
        result = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu bytes", path, (unsigned long long)size);
    else if (fread(buffer, 1, (size_t)size, file) != size)
        result = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", path, strerror(errno ? errno : EIO));
    fclose(file);
    if (result != ADCGS_OK) {
        free(buffer);
        return result;
    }
    buffer[size] = 0;
    *data = buffer;
    *bytes = (size_t)size;
    return ADCGS_OK;
}
