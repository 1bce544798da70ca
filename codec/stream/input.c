/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sources of streams, and the digest of a trace. */
#define _POSIX_C_SOURCE 200809L /* files beyond 2 GiB, where long has 32 bits */
#define _FILE_OFFSET_BITS 64

#include "stream/input.h"

#include "base/base.h"

#include <stdio.h>

int64_t adcgs_span_read(void *user, void *buffer, size_t bytes)
{
    adcgs_span *s = user;
    size_t n = ADCGS_MIN(bytes, s->left);
    if (s->step > 0) {
        s->turn = s->turn % s->step + 1;
        n = ADCGS_MIN(n, (size_t)s->turn);
    }
    if (n > 0) {
        memcpy(buffer, s->next, n);
        s->next += n;
        s->left -= n;
    }
    return (int64_t)n;
}

int64_t adcgs_file_read(void *user, void *buffer, size_t bytes)
{
    FILE *file = user;
    const size_t n = fread(buffer, 1, bytes, file);
    return n == 0 && ferror(file) ? -1 : (int64_t)n;
}

int64_t adcgs_file_read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    FILE *file = user;
    if (offset > INT64_MAX || fseeko(file, (off_t)offset, SEEK_SET))
        return -1;
    const size_t n = fread(buffer, 1, bytes, file);
    return n == 0 ? -1 : (int64_t)n;
}

void adcgs_trace_sum_init(adcgs_trace_sum *sum)
{
    adcgs_md5_init(&sum->md5);
    sum->lines = 0;
}

void adcgs_trace_sum_add(void *user, uint64_t bit, const char *element, const char *value)
{
    adcgs_trace_sum *sum = user;
    char number[24];
    const int n = snprintf(number, sizeof number, "%llu ", (unsigned long long)bit);
    adcgs_md5_update(&sum->md5, number, (size_t)n);
    adcgs_md5_update(&sum->md5, element, strlen(element));
    adcgs_md5_update(&sum->md5, " ", 1);
    adcgs_md5_update(&sum->md5, value, strlen(value));
    adcgs_md5_update(&sum->md5, "\n", 1);
    sum->lines++;
}

void adcgs_trace_sum_final(adcgs_trace_sum *sum, char hex[33])
{
    uint8_t digest[16];
    adcgs_md5_final(&sum->md5, digest);
    adcgs_md5_hex(digest, hex);
}
