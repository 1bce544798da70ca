/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Builds one JSON value and writes it, by jansson. What comes out is ASCII, and
 * so UTF-8 and safe for a terminal: other characters are escapes. Strings may hold
 * any bytes; U+FFFD stands for each that belongs to no character of UTF-8.
 */
#ifndef ADCGS_IO_JSON_H
#define ADCGS_IO_JSON_H

#include "base/base.h"

#include <stdio.h>

#define ADCGS_JSON_DEPTH 8
#define ADCGS_JSON_DIGITS 10 /**< of reports; 17 give each double back */

struct json_t;

typedef struct adcgs_json {
    int digits;  /**< of numbers; ADCGS_JSON_DIGITS unless set after adcgs_json_init() */
    int is_line; /**< all in one line; 0 unless set then */
    /* Private. */
    struct json_t *open[ADCGS_JSON_DEPTH]; /**< the value, and what is open in it */
    int depth, failed;
} adcgs_json;

/** What fails until adcgs_json_write() is said there. */
void adcgs_json_init(adcgs_json *json);
/* key is NULL inside an array and at the top, which is an object or an array. Keys of an object differ. */
void adcgs_json_open(adcgs_json *json, const char *key, char bracket); /**< bracket: '{' or '[' */
void adcgs_json_close(adcgs_json *json);
void adcgs_json_string(adcgs_json *json, const char *key, const char *value);
void adcgs_json_int(adcgs_json *json, const char *key, int64_t value);
void adcgs_json_real(adcgs_json *json, const char *key, double value); /**< whole numbers without a point; null when not finite */
void adcgs_json_bool(adcgs_json *json, const char *key, int value);
/** Write the value and a newline, flush; name: of the file, for the message. Clears. */
adcgs_status adcgs_json_write(adcgs_json *json, FILE *file, const char *name, adcgs_error *error);
/** Also of one that was written, or never begun but zero. */
void adcgs_json_clear(adcgs_json *json);

#endif
