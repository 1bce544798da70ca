/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Opening and loading files. */
#include "config.h"

#include "system/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/** Open without waiting, as a pipe without a writer would make us do, and reject anything but a regular file. */
static adcgs_status open_regular(int *fd, uint64_t *size, const char *path, adcgs_error *error)
{
    struct stat status;
    *size = 0;
    *fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    adcgs_status result = ADCGS_OK;
    if (*fd < 0 || fstat(*fd, &status))
        result = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(errno));
    else if (!S_ISREG(status.st_mode))
        result = adcgs_fail(error, ADCGS_ERR_IO, "%s: not a regular file", path);
    else
        *size = (uint64_t)status.st_size;
    if (result != ADCGS_OK && *fd >= 0)
        close(*fd);
    return result;
}

adcgs_status adcgs_file_open(FILE **out, const char *path, adcgs_error *error)
{
    int fd;
    uint64_t size;
    *out = NULL;
    ADCGS_TRY(open_regular(&fd, &size, path, error));
    *out = fdopen(fd, "rb");
    if (*out)
        return ADCGS_OK;
    close(fd);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

adcgs_status adcgs_file_check(const char *path, const char *what, adcgs_error *error)
{
    int fd;
    uint64_t size;
    ADCGS_TRY(open_regular(&fd, &size, path, error));
    close(fd);
    return size ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: empty, expected %s", path, what);
}

adcgs_status adcgs_file_load_open(uint8_t **data, size_t *bytes, FILE *file, const char *path, uint64_t limit, adcgs_error *error)
{
    struct stat status;
    uint8_t *buffer = NULL;
    *data = NULL;
    *bytes = 0;
    if (fstat(fileno(file), &status))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", path, strerror(errno));
    const uint64_t size = (uint64_t)status.st_size;
    adcgs_status result = ADCGS_OK;
    errno = 0;
    if (size > limit || size >= SIZE_MAX)
        result = adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu bytes, expected at most %llu", path, (unsigned long long)size,
                            (unsigned long long)limit);
    else if (!(buffer = malloc((size_t)size + 1)))
        result = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu bytes", path, (unsigned long long)size);
    else if (fread(buffer, 1, (size_t)size, file) != size)
        result = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read: %s", path, strerror(errno ? errno : EIO));
    if (result != ADCGS_OK) {
        free(buffer);
        return result;
    }
    buffer[size] = 0;
    *data = buffer;
    *bytes = (size_t)size;
    return ADCGS_OK;
}

adcgs_status adcgs_file_load(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error)
{
    FILE *file;
    *data = NULL;
    *bytes = 0;
    ADCGS_TRY(adcgs_file_open(&file, path, error));
    const adcgs_status status = adcgs_file_load_open(data, bytes, file, path, limit, error);
    fclose(file);
    return status;
}

size_t adcgs_file_mark(const void *text, size_t bytes)
{
    static const uint8_t mark[3] = {0xef, 0xbb, 0xbf};
    return bytes >= sizeof mark && !memcmp(text, mark, sizeof mark) ? sizeof mark : 0;
}

adcgs_status adcgs_file_load_text(uint8_t **data, size_t *bytes, const char *path, uint64_t limit, adcgs_error *error)
{
    ADCGS_TRY(adcgs_file_load(data, bytes, path, limit, error));
    if (*bytes >= 2 && ((**data == 0xff && (*data)[1] == 0xfe) || (**data == 0xfe && (*data)[1] == 0xff))) {
        free(*data);
        *data = NULL;
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: text in UTF-16, expected UTF-8: save it in UTF-8", path);
    }
    const size_t mark = adcgs_file_mark(*data, *bytes);
    *bytes -= mark;
    memmove(*data, *data + mark, *bytes + 1);
    return ADCGS_OK;
}
