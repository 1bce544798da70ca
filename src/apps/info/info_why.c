/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --why. */
#include "apps/info/info_why.h"

#include "system/text.h"

#include <stdlib.h>

static const char *find_meta(const adcgs_stream *stream, const char *key)
{
    for (uint32_t i = 0; i < stream->n_meta; i++)
        if (!strcmp(stream->meta[i].key, key))
            return stream->meta[i].value;
    return NULL;
}

/** The number after "name=" in the list; 0 if there is none. */
static double find_number(const char *list, const char *name)
{
    const size_t length = strlen(name);
    for (const char *at = list; at && *at; at = strchr(at, ' ') ? strchr(at, ' ') + 1 : NULL)
        if (!strncmp(at, name, length) && at[length] == '=') {
            const double x = strtod(at + length + 1, NULL);
            return x > 0 && x < 1e12 ? x : 0;
        }
    return 0;
}

static void print_share(const char *name, uint64_t bytes, uint64_t total)
{
    printf("%-11s %9llu bytes %5.1f %%", name, (unsigned long long)bytes, 100.0 * (double)bytes / (double)total);
}

static void print_bytes(const adcgs_info_report *r)
{
    const adcgs_info *i = &r->info;
    const adcgs_bytes *b = &i->bytes;
    const uint64_t features = b->layer[0] + b->layer[1] + b->layer[2] + b->layer[3] + b->layer[4];
    const uint32_t moving = r->stream.params.time_rows ? i->anchors - i->static_anchors : 0;
    print_share("features", features, b->total);
    printf("  of %u anchors (%u moving), with %u primitives, %.1f of at most %d each\n", i->anchors, moving, i->gaussians,
           (double)i->gaussians / (double)i->anchors, i->k);
    print_share("positions", b->geometry, b->total);
    printf("  %.1f bits an anchor\n", 8.0 * (double)b->geometry / (double)i->anchors);
    print_share("networks", b->networks, b->total);
    printf("  %u weights of %.1f bits\n", i->weights, i->weights ? 8.0 * (double)b->networks / (double)i->weights : 0);
    print_share("cameras", b->cameras, b->total);
    printf("  %u of them\n", r->stream.n_cameras);
    print_share("the rest", b->header + b->metadata, b->total);
    printf("  headers, index, metadata\n");
}

static void print_anchors(const char *list)
{
    const double points = find_number(list, "points"), most = find_number(list, "most");
    const double refused = find_number(list, "refused"), details = find_number(list, "details");
    printf("anchors     %.0f allowed", find_number(list, "allowed"));
    if (details > 0)
        printf(" for %.0f details of an image", details);
    printf("; %.0f at the start", find_number(list, "began"));
    if (points > 0)
        printf(", with %.0f known points", points);
    printf("; %.0f at most", most);
    if (refused > 0)
        printf(", %.0f further candidates exceeded the limit", refused);
    printf("; %.0f nearly invisible ones were removed\n", find_number(list, "idle"));
}

static void print_motion(const char *list)
{
    const double still = find_number(list, "still"), moving = find_number(list, "moving");
    const double unchanging = find_number(list, "unchanging"), unmoved = find_number(list, "unmoved");
    if (still > 0 && moving > 0)
        printf("motion      image loss %.4g with motion, %.4g without\n", moving, still);
    if (unchanging > 0 || unmoved > 0)
        printf("static      %.0f anchors since the images do not change there, %.0f since their motion is invisible\n",
               unchanging, unmoved);
}

static void print_reasons(const char *list)
{
    const double unseen = find_number(list, "unseen"), faint = find_number(list, "faint");
    print_anchors(list);
    if (unseen > 0 || faint > 0)
        printf("primitives  %.0f that covered almost nothing were removed, and %.0f faint ones\n", unseen, faint);
    const double units = find_number(list, "units");
    if (units > 0)
        printf("networks    %.0f hidden units that did not justify their bits were removed\n", units);
    print_motion(list);
}

static void print_setting(const adcgs_stream *stream, const char *key)
{
    const char *const value = find_meta(stream, key);
    if (!value)
        return;
    printf("%-11s ", key);
    adcgs_text_show(stdout, value);
    putchar('\n');
}

void adcgs_info_why(const adcgs_info_report *r, const char *name)
{
    static const char *const settings[] = {"preset", "iterations", "lambda", "settings", "trials"};
    const char *const list = find_meta(&r->stream, "decisions");
    adcgs_text_show(stdout, name);
    printf(": %llu bytes\n\n", (unsigned long long)r->info.bytes.total);
    print_bytes(r);
    putchar('\n');
    if (list && r->info.segments > 1)
        printf("First segment:\n");
    if (list)
        print_reasons(list);
    else
        printf("The encoder stored no reasons.\n");
    for (size_t i = 0; i < ADCGS_COUNTOF(settings); i++)
        print_setting(&r->stream, settings[i]);
}
