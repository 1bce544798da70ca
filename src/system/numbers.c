/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parsing of numbers. Uses no system calls. */
#include "config.h"

#include "system/numbers.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/** The factor of a suffix, in a table that ends with NULL; 0 for an unknown suffix. */
static double unit_of(const char *suffix, const char *const *names, const double *factors)
{
    for (; *names; names++, factors++)
        if (!strcmp(*names, suffix))
            return *factors;
    return 0.0;
}

/** Parse a number with a unit, of digits, point and sign only. 0, or -1 for other text and outside [min, max]. */
static int parse_with_unit(const char *text, double min, double max, const char *const *names, const double *factors, double *out)
{
    char *end;
    const double number = strtod(text, &end);
    if (end == text || (size_t)(end - text) != strspn(text, "+-.0123456789"))
        return -1;
    const double factor = unit_of(end, names, factors), value = number * factor;
    if (!(factor > 0.0) || !isfinite(value) || value < min || value > max)
        return -1;
    *out = value;
    return 0;
}

int adcgs_parse_count(const char *text, int min, int max, int *out)
{
    static const char *const names[] = {"k", "K", "M", NULL};
    static const double factors[] = {1e3, 1e3, 1e6};
    double value;
    if (!adcgs_parse_int(text, min, max, out))
        return 0;
    if (parse_with_unit(text, min, max, names, factors, &value) || fabs(value - round(value)) > 1e-6) /* 1.001k is whole */
        return -1;
    *out = (int)round(value);
    return 0;
}

int adcgs_parse_seconds(const char *text, double min, double max, double *out)
{
    static const char *const names[] = {"ms", "s", "sec", "m", "min", "h", NULL};
    static const double factors[] = {1e-3, 1.0, 1.0, 60.0, 60.0, 3600.0};
    return adcgs_parse_real(text, min, max, out) ? parse_with_unit(text, min, max, names, factors, out) : 0;
}

/** Bytes of a suffix: none (1), k, M, G (powers of 1000), Ki, Mi, Gi (of 1024), with or without B; else 0. */
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
    char first[32];
    const char *const colon = strchr(text, ':');
    const size_t n = colon ? (size_t)(colon - text) : strlen(text);
    double a, b;
    if (n >= sizeof first)
        return -1;
    memcpy(first, text, n);
    first[n] = '\0';
    if (adcgs_parse_seconds(first, -HUGE_VAL, HUGE_VAL, &a))
        return -1;
    b = a;
    if (colon && adcgs_parse_seconds(colon + 1, a, HUGE_VAL, &b))
        return -1;
    *begin = a;
    *end = b;
    return 0;
}
