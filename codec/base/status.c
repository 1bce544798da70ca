/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Status codes: their names, recording of error messages, formatting of log messages. */
#include "base/base.h"
#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

typedef struct status_row {
    adcgs_status status;
    const char *name;
} status_row;

static const status_row rows[] = {
    {ADCGS_OK, "success"},
    {ADCGS_ERR_USAGE, "wrong use"},
    {ADCGS_ERR_MEMORY, "out of memory"},
    {ADCGS_ERR_IO, "input/output error"},
    {ADCGS_ERR_DATA, "invalid data"},
    {ADCGS_ERR_TRUNCATED, "truncated data"},
    {ADCGS_ERR_UNSUPPORTED, "unsupported"},
    {ADCGS_ERR_LIMIT, "limit exceeded"},
    {ADCGS_ERR_FPENV, "no strict binary32"},
    {ADCGS_ERR_INTERNAL, "internal error"},
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

void adcgs_one_line(char *text)
{
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
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
        adcgs_one_line(error->text);
    }
    return status;
}

void adcgs_log_say(const adcgs_log *log, adcgs_log_level level, const char *format, ...)
{
    char text[ADCGS_ERROR_TEXT];
    va_list args;
    if (!log->fn)
        return;
    va_start(args, format);
    const int n = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (n < 0)
        return;
    adcgs_one_line(text);
    log->fn(log->user, level, text);
}

void adcgs_error_locate(adcgs_error *error, const char *name)
{
    static const char general[] = "stream: ";
    char text[sizeof error->text];
    if (!error || error->status == ADCGS_OK || error->status == ADCGS_ERR_USAGE || error->status == ADCGS_ERR_FPENV)
        return;
    const size_t skip = strncmp(error->text, general, sizeof general - 1) == 0 ? sizeof general - 1 : 0;
    memcpy(text, error->text, sizeof text);
    /* A long name is cut, so that the start of the message still fits. */
    if (snprintf(error->text, sizeof error->text, "%.160s: %s", name, text + skip) < 0)
        error->text[0] = 0;
}
