/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing JSON. */
#include "config.h"

#include "system/json.h"

#include "system/flush.h"
#include "system/text.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#define WHOLE_MAX 9007199254740992.0 /* 2^53: whole numbers below it are exact; arithmetic */

void adcgs_json_init(adcgs_json *json)
{
    *json = (adcgs_json){.digits = ADCGS_JSON_DIGITS};
}

void adcgs_json_clear(adcgs_json *json)
{
    json_decref(json->open[0]);
    *json = (adcgs_json){0};
}

/** Add a value and take its ownership; NULL stands for an allocation failure. */
static void add(adcgs_json *json, const char *key, json_t *value)
{
    json_t *const parent = json->depth ? json->open[json->depth - 1] : NULL;
    if (!value || json->failed) {
        json->failed = 1;
        json_decref(value);
    } else if (!parent)
        json->open[0] = value;
    else if (json_is_array(parent))
        json->failed = json_array_append_new(parent, value) != 0;
    else {
        char *const name = adcgs_text_utf8(key);
        json->failed = json_object_set_new(parent, name, value) != 0; /* fails if name is NULL */
        free(name);
    }
}

void adcgs_json_open(adcgs_json *json, const char *key, char bracket)
{
    json_t *const value = bracket == '{' ? json_object() : json_array();
    add(json, key, value);
    if (json->failed || json->depth == ADCGS_JSON_DEPTH) {
        json->failed = 1;
        return;
    }
    json->open[json->depth++] = value;
}

void adcgs_json_close(adcgs_json *json)
{
    if (!json->failed)
        json->depth--;
}

void adcgs_json_string(adcgs_json *json, const char *key, const char *value)
{
    char *const text = adcgs_text_utf8(value);
    add(json, key, text ? json_string(text) : NULL);
    free(text);
}

void adcgs_json_int(adcgs_json *json, const char *key, int64_t value)
{
    add(json, key, json_integer(value));
}

void adcgs_json_real(adcgs_json *json, const char *key, double value)
{
    const int is_whole = fabs(value) < WHOLE_MAX && value == floor(value);
    add(json, key, is_whole ? json_integer((json_int_t)value) : isfinite(value) ? json_real(value) : json_null());
}

void adcgs_json_bool(adcgs_json *json, const char *key, int value)
{
    add(json, key, json_boolean(value));
}

adcgs_status adcgs_json_write(adcgs_json *json, FILE *file, const char *name, adcgs_error *error)
{
    const size_t flags = (json->is_line ? JSON_COMPACT : JSON_INDENT(2)) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(json->digits);
    int failed = json->failed;
    if (!failed && !json_dumpf(json->open[0], file, flags))
        fputc('\n', file);
    else
        failed |= !ferror(file);
    adcgs_json_clear(json);
    if (failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for JSON", name);
    const int reason = adcgs_file_flush(file);
    return reason ? adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", name, strerror(reason)) : ADCGS_OK;
}
