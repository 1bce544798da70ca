/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Status codes: their names, their exit codes, and how an error message is recorded. */
#include "base/base.h"

#include <stdarg.h>
#include <stdio.h>

typedef struct status_row {
    adcgs_status status;
    int exit_code;
    const char *name;
} status_row;

static const status_row rows[] = {
    { ADCGS_OK, 0, "success" },
    { ADCGS_ERR_USAGE, 2, "wrong use" },
    { ADCGS_ERR_MEMORY, 3, "out of memory" },
    { ADCGS_ERR_IO, 3, "input/output error" },
    { ADCGS_ERR_DATA, 4, "invalid data" },
    { ADCGS_ERR_TRUNCATED, 4, "truncated data" },
    { ADCGS_ERR_UNSUPPORTED, 5, "unsupported" },
    { ADCGS_ERR_LIMIT, 4, "limit exceeded" },
    { ADCGS_ERR_FPENV, 5, "no strict binary32" },
    { ADCGS_ERR_INTERNAL, 1, "internal error" },
};

static const status_row *find_row(adcgs_status status)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++)
        if (rows[i].status == status)
            return &rows[i];
    return &rows[ADCGS_COUNTOF(rows) - 1];
}

const char *adcgs_status_name(adcgs_status status)
{
    return find_row(status)->name;
}

int adcgs_status_exit_code(adcgs_status status)
{
    return find_row(status)->exit_code;
}

adcgs_status adcgs_fail(adcgs_error *error, adcgs_status status, const char *format, ...)
{
    if (error) {
        va_list args;
        va_start(args, format);
        error->status = status;
        if (vsnprintf(error->text, sizeof error->text, format, args) < 0)
            error->text[0] = 0;
        va_end(args);
        for (char *c = error->text; *c; c++)
            if ((unsigned char)*c < ' ' || *c == 127)
                *c = '?';
    }
    return status;
}

void adcgs_error_locate(adcgs_error *error, const char *name)
{
    static const char general[] = "stream: ";
    char text[sizeof error->text];
    if (!error || error->status == ADCGS_OK || error->status == ADCGS_ERR_USAGE || error->status == ADCGS_ERR_FPENV)
        return;
    const size_t skip = strncmp(error->text, general, sizeof general - 1) == 0 ? sizeof general - 1 : 0;
    memcpy(text, error->text, sizeof text);
    /* A name of any length leaves room for the start of the message. */
    if (snprintf(error->text, sizeof error->text, "%.160s: %s", name, text + skip) < 0)
        error->text[0] = 0;
}
