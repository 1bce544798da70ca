/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers as text: with a range, units and suffixes. */
#ifndef ADCGS_SYSTEM_NUMBERS_H
#define ADCGS_SYSTEM_NUMBERS_H

#include <stdint.h>

/* Parsers of whole strings: 0, or -1 if text is not exactly one number of the kind within [min, max]. */
int adcgs_parse_int(const char *text, int min, int max, int *out);
/** The same, also accepting thousands (20k, 1.5k) and millions (2M) that are whole numbers. */
int adcgs_parse_count(const char *text, int min, int max, int *out);
/** Seconds, or with a unit: 500ms, 2s, 10m or 10min, 1.5h. */
int adcgs_parse_seconds(const char *text, double min, double max, double *out);
/**
 * Digits. With a suffix (k, M, G, or Ki, Mi, Gi, each also followed by B) a decimal fraction is allowed and rounded down: 1.5M.
 */
int adcgs_parse_size(const char *text, uint64_t min, uint64_t max, uint64_t *out);
int adcgs_parse_real(const char *text, double min, double max, double *out);
int adcgs_parse_pair(const char *text, int min, int max, int out[2]);
/** "T" or "A:B" in the form of adcgs_parse_seconds(); *end == *begin for the former. */
int adcgs_parse_times(const char *text, double *begin, double *end);

#endif
