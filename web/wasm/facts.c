/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Summary of a stream as JSON, like the first part of adcgs-info's report. */
#include "config.h"

#include "wasm/export.h"
#include "wasm/page_scene.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#define META_SHOWN 64 /* texts; streams may have many more */

/* The JSON written so far. If memory runs out, whole members are left out. */
typedef struct text {
    char *data;
    size_t used, room;
} text;

static void put(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(text *t, const char *format, ...)
{
    for (;;) {
        va_list arguments;
        va_start(arguments, format);
        const int n = vsnprintf(t->data + t->used, t->room - t->used, format, arguments);
        va_end(arguments);
        if (n >= 0 && (size_t)n < t->room - t->used) {
            t->used += (size_t)n;
            return;
        }
        char *grown = n < 0 ? NULL : realloc(t->data, 2 * t->room + (size_t)n);
        if (!grown)
            return;
        t->data = grown;
        t->room = 2 * t->room + (size_t)n;
    }
}

/* Untrusted text: it should be UTF-8; the reader of the JSON replaces invalid bytes. */
static void put_string(text *t, const char *s)
{
    put(t, "\"");
    for (; *s; s++)
        if (*s == '"' || *s == '\\' || (unsigned char)*s < 0x20)
            put(t, "\\u%04x", (unsigned)(unsigned char)*s);
        else
            put(t, "%c", *s);
    put(t, "\"");
}

/* JSON has no infinity. */
static void put_number(text *t, const char *name, double value)
{
    if (isfinite(value))
        put(t, ",\"%s\":%.17g", name, value);
    else
        put(t, ",\"%s\":null", name);
}

static void put_bytes(text *t, const adcgs_bytes *b)
{
    put(t, ",\"bytes\":{\"total\":%llu,\"header\":%llu,\"networks\":%llu,\"geometry\":%llu", (unsigned long long)b->total,
        (unsigned long long)b->header, (unsigned long long)b->networks, (unsigned long long)b->geometry);
    for (int i = 0; i < 5; i++)
        put(t, ",\"layer%d\":%llu", i, (unsigned long long)b->layer[i]);
    put(t, ",\"cameras\":%llu,\"metadata\":%llu}", (unsigned long long)b->cameras, (unsigned long long)b->metadata);
}

static void put_metadata(text *t, const adcgs_decoder *decoder, int n)
{
    put(t, ",\"metadata\":[");
    for (int i = 0; i < n && i < META_SHOWN; i++) {
        const char *key = adcgs_get_metadata_key(decoder, i), *value = key ? adcgs_get_metadata(decoder, key) : NULL;
        if (!value)
            break;
        put(t, i ? ",[" : "[");
        put_string(t, key);
        put(t, ",");
        put_string(t, value);
        put(t, "]");
    }
    put(t, "]");
}

/** Valid until the next call; NULL if nothing is known yet. */
const char *PAGE_EXPORT(page_facts)(void)
{
    static text t;
    const adcgs_decoder *decoder = adcgs_page_decoder();
    adcgs_info info;
    if (!decoder || adcgs_get_info(decoder, &info, sizeof info, NULL) != ADCGS_OK)
        return NULL;
    if (!t.data) {
        t.data = malloc(4096);
        t.room = t.data ? 4096 : 0;
    }
    if (!t.data)
        return NULL;
    t.used = 0;
    put(&t, "{\"library\":\"%s\",\"version\":\"%d.%d\",\"level\":%d", adcgs_version_string(), info.version_major,
        info.version_minor, info.level);
    put(&t, ",\"segments\":%d,\"segments_total\":%d,\"anchors\":%u,\"static_anchors\":%u,\"gaussians\":%u,\"weights\":%u",
        info.segments, info.segments_total, (unsigned)info.anchors, (unsigned)info.static_anchors, (unsigned)info.gaussians,
        (unsigned)info.weights);
    put(&t,
        ",\"layers\":%d,\"tiers\":%d,\"tiers_present\":%d,\"tiers_received\":%d,\"cameras\":%d,\"truncated\":%d,\"faults\":%d",
        info.layers, info.tiers, info.tiers_present, info.tiers_received, info.cameras, info.truncated, info.faults);
    put_number(&t, "time_start", info.time_start);
    put_number(&t, "time_end", info.time_end);
    put_number(&t, "time_available", info.time_available);
    put_number(&t, "frame_rate", info.frame_rate);
    put(&t, ",\"background\":[%.9g,%.9g,%.9g]", (double)info.background[0], (double)info.background[1],
        (double)info.background[2]);
    put_number(&t, "scale", info.scene_scale);
    put(&t, ",\"origin\":[%.17g,%.17g,%.17g],\"colour\":", info.scene_origin[0], info.scene_origin[1], info.scene_origin[2]);
    put_string(&t, info.colour);
    put(&t, ",\"axes\":");
    put_string(&t, info.axes);
    put(&t, ",\"units\":");
    put_string(&t, info.units);
    put_bytes(&t, &info.bytes);
    put_metadata(&t, decoder, info.metadata);
    put(&t, "}");
    return t.data;
}
