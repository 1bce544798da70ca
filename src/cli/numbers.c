/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers that command lines give, and the one that a program leaves with. Needs nothing of a system. */
#include "config.h"

#include "cli/cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

int adcgs_exit_code(adcgs_status status)
{
    switch (status) {
    case ADCGS_OK:
        return 0;
    case ADCGS_ERR_USAGE:
        return 2;
    case ADCGS_ERR_MEMORY:
    case ADCGS_ERR_IO:
        return 3;
    case ADCGS_ERR_DATA:
    case ADCGS_ERR_TRUNCATED:
    case ADCGS_ERR_LIMIT:
        return 4;
    case ADCGS_ERR_UNSUPPORTED:
    case ADCGS_ERR_FPENV:
        return 5;
    default:
        return 1;
    }
}

int adcgs_parse_real(const char *text, double min, double max, double *out)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !isfinite(value) || value < min || value > max)
        return -1;
    *out = value;
    return 0;
}

int adcgs_parse_int(const char *text, int min, int max, int *out)
{
    char *end;
    errno = 0;
    const long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < min || value > max)
        return -1;
    *out = (int)value;
    return 0;
}

/** Bytes that a suffix stands for: none (1), k, M, G (powers of 1000), Ki, Mi, Gi (of 1024), with or without B; else 0. */
static uint64_t size_unit(const char *suffix)
{
    static const char letters[] = "kMG";
    if (!*suffix)
        return 1;
    const char *found = strchr(letters, *suffix == 'K' ? 'k' : *suffix == 'm' ? 'M' : *suffix == 'g' ? 'G' : *suffix);
    if (!found)
        return 0;
    const int binary = suffix[1] == 'i';
    suffix += 1 + binary;
    if (*suffix && strcmp(suffix, "B") != 0)
        return 0;
    uint64_t unit = 1;
    for (const char *letter = letters; letter <= found; letter++)
        unit *= binary ? 1024 : 1000;
    return unit;
}

int adcgs_parse_size(const char *text, uint64_t min, uint64_t max, uint64_t *out)
{
    char *end;
    if (*text < '0' || *text > '9') /* strtoull accepts a sign and wraps */
        return -1;
    errno = 0;
    const unsigned long long whole = strtoull(text, &end, 10);
    uint64_t digits = 0, scale = 1;
    const char *rest = end;
    if (*rest == '.')
        for (rest++; *rest >= '0' && *rest <= '9' && scale < 1000000000; rest++, scale *= 10)
            digits = 10 * digits + (uint64_t)(*rest - '0');
    const uint64_t unit = size_unit(rest);
    if (errno || !unit || (rest != end && (scale == 1 || unit == 1)) || whole > (UINT64_MAX - unit) / unit)
        return -1;
    const uint64_t value = whole * unit + digits * unit / scale;
    if (value < min || value > max)
        return -1;
    *out = value;
    return 0;
}

int adcgs_parse_pair(const char *text, int min, int max, int out[2])
{
    char first[16];
    const char *x = strchr(text, 'x');
    if (!x || (size_t)(x - text) >= sizeof first)
        return -1;
    memcpy(first, text, (size_t)(x - text));
    first[x - text] = 0;
    int pair[2];
    if (adcgs_parse_int(first, min, max, &pair[0]) || adcgs_parse_int(x + 1, min, max, &pair[1]))
        return -1;
    out[0] = pair[0];
    out[1] = pair[1];
    return 0;
}

int adcgs_parse_times(const char *text, double *begin, double *end)
{
    char *stop;
    const double a = strtod(text, &stop);
    if (stop == text || !isfinite(a))
        return -1;
    double b = a;
    if (*stop == ':' && (adcgs_parse_real(stop + 1, a, HUGE_VAL, &b)))
        return -1;
    if (*stop && *stop != ':')
        return -1;
    *begin = a;
    *end = b;
    return 0;
}
