/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Builds one JSON value and writes it, by jansson. The output is ASCII, hence
 * UTF-8 and safe for a terminal: other characters are escaped. Strings may hold
 * any bytes; U+FFFD replaces each byte that belongs to no UTF-8 character.
 */
#ifndef ADCGS_SYSTEM_JSON_H
#define ADCGS_SYSTEM_JSON_H

#include "base/base.h"

#include <stdio.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define ADCGS_JSON_DEPTH 8   /**< nested objects and arrays */
#define ADCGS_JSON_DIGITS 10 /**< significant digits in reports; 17 preserve each double */

struct json_t;

typedef struct adcgs_json {
    int digits;  /**< significant digits; adcgs_json_init() sets ADCGS_JSON_DIGITS */
    int is_line; /**< true: output in one line; adcgs_json_init() sets 0 */
    /* Private. */
    struct json_t *open[ADCGS_JSON_DEPTH]; /**< the value, and its open objects and arrays */
    int depth, failed;
} adcgs_json;

/** Start a value. adcgs_json_write() reports failures of the calls before it. */
void adcgs_json_init(adcgs_json *json);
/* key is NULL inside an array and at the top, which is an object or an array. Keys of an object must differ. */
void adcgs_json_open(adcgs_json *json, const char *key, char bracket); /**< bracket: '{' or '[' */
void adcgs_json_close(adcgs_json *json);
void adcgs_json_string(adcgs_json *json, const char *key, const char *value);
void adcgs_json_int(adcgs_json *json, const char *key, int64_t value);
void adcgs_json_real(adcgs_json *json, const char *key, double value); /**< whole numbers without a decimal point; null if not
                                                                            finite */
void adcgs_json_bool(adcgs_json *json, const char *key, int value);
/** Write the value and a newline, then flush and clear. name: of the file, for the message. */
adcgs_status adcgs_json_write(adcgs_json *json, FILE *file, const char *name, adcgs_error *error);
/** Free the value; harmless after writing, and on a zeroed struct. */
void adcgs_json_clear(adcgs_json *json);

#endif
