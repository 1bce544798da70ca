/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Random recipes. Numbers at the ends of their ranges occur more often than in a uniform choice. */
#include "random_recipe.h"

#include "random_model.h"

#include <stdarg.h>

#define COUNT(list) ((int)ADCGS_COUNTOF(list))

/** The recipe being written, and choices on which later lines depend. */
typedef struct writer {
    adcgs_recipe *recipe;
    FILE *text;
    uint64_t state;
    adcgs_status status;
    adcgs_error *error;
    int n_fg, chunks, adaptive, moving, segments, anchors, depth, slice_log2, tiered;
} writer;

static void line(writer *w, const char *format, ...) ADCGS_PRINTF(2, 3);

static void line(writer *w, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (w->text)
        fprintf(w->text, "%s\n", text);
    if (w->status == ADCGS_OK)
        w->status = adcgs_recipe_add(w->recipe, text, w->error);
}

static int draw(writer *w, int lo, int hi)
{
    return (int)adcgs_random_range(&w->state, lo, hi);
}

/* True with probability 1/n. */
static int once_in(writer *w, int n)
{
    return draw(w, 1, n) == 1;
}

/* A number of the range; with probability 1/3 one of its ends. */
static int edgy(writer *w, int lo, int hi)
{
    return once_in(w, 3) ? (draw(w, 0, 1) ? lo : hi) : draw(w, lo, hi);
}

static void write_params(writer *w)
{
    static const int rows[] = {1, 2, 3, 7, 40};
    const int small = draw(w, 0, 3);
    w->chunks = draw(w, 1, 4);
    w->n_fg = w->chunks * draw(w, 0, small ? 3 : 32 / w->chunks);
    w->moving = draw(w, 0, 2) > 0;
    line(w, "params k=%d n_fv=%d n_fg=%d chunks=%d n_eta=%d", edgy(w, 1, small ? 5 : 16), edgy(w, 1, small ? 12 : 64), w->n_fg,
         w->chunks, edgy(w, 0, 8));
    w->adaptive = once_in(w, 3);
    if (w->adaptive)
        line(w, "params adaptive_steps=1");
    line(w, "params octaves=%d fine_uses_fv=%d coarse_rotation=%d", edgy(w, 0, small ? 4 : 10), draw(w, 0, 1), draw(w, 0, 1));
    if (w->moving)
        line(w, "params time_rows=%d time_width=%d spans=%d bodies=%d smooth_time=%d", rows[draw(w, 0, COUNT(rows) - 1)],
             edgy(w, 1, 9), draw(w, 0, 1), draw(w, 0, 1) * edgy(w, 1, 15), draw(w, 0, 1));
}

static void write_geometry(writer *w)
{
    static const int counts[] = {1, 2, 63, 64, 65, 127, 128, 129, 130};
    static const char *const spreads[] = {"random", "random", "dense", "mixed", "ends"};
    int depth = 0;
    w->anchors = once_in(w, 2) ? counts[draw(w, 0, COUNT(counts) - 1)] : draw(w, 1, 180);
    while (1LL << 3 * depth < w->anchors)
        depth++;
    depth = once_in(w, 4) ? depth : draw(w, depth, once_in(w, 3) ? 21 : depth + 6);
    w->slice_log2 = once_in(w, 6) ? 16 : draw(w, 6, 8);
    line(w, "level %d", depth > 16 ? 3 : depth > 12 ? 2 : draw(w, 1, 3));
    line(w, "depth %d", depth);
    w->depth = depth;
    line(w, "slice_log2 %d", w->slice_log2);
    line(w, "positions %s", spreads[draw(w, 0, COUNT(spreads) - 1)]);
    if (once_in(w, 6))
        line(w, "origin %d.5 %d %d.25", draw(w, -999, 999), draw(w, -32768, 32768), draw(w, -9, 9));
}

/* Anchors and predicted segments. New anchors always find a free voxel, and no segment is left without anchors. */
static void write_anchors(writer *w)
{
    static const char *const holds[] = {"all", "refined", "first", "random", "random", "none", "turns"};
    static const char *const changes[] = {"small", "small", "escapes", "clips"};
    static const char *const groups[] = {"", " fv", " sigma colour"};
    const int roomy = 1LL << 3 * w->depth >= 1LL * w->anchors * w->segments;
    const int hold = draw(w, 0, roomy ? COUNT(holds) - 1 : 2), predicts = once_in(w, 2);
    char text[200] = "anchors", which[40] = "predicted";
    size_t n = strlen(text), m = strlen(which);
    for (int i = 0; i < w->segments; i++) {
        const int predicted = i > 0 && predicts && draw(w, 0, 2);
        const int lo = predicted && hold < 3 ? 0 : 1, hi = predicted && !roomy ? 0 : w->anchors;
        n += (size_t)snprintf(text + n, sizeof text - n, " %d", i == 0 ? w->anchors : edgy(w, lo, hi));
        if (predicted)
            m += (size_t)snprintf(which + m, sizeof which - m, " %d", i);
    }
    line(w, "%s", text);
    w->tiered = once_in(w, 2);
    if (w->tiered)
        line(w, "tiers %d %d %d %d", edgy(w, 1, 8), edgy(w, 0, 16), edgy(w, 0, 16), edgy(w, 0, 16));
    if (!strchr(which, ' '))
        return;
    line(w, "%s", which);
    line(w, "kept %s", holds[hold]);
    line(w, "differences %s%s", changes[draw(w, 0, COUNT(changes) - 1)], groups[draw(w, 0, COUNT(groups) - 1)]);
}

static void write_segments(writer *w)
{
    int64_t tick = draw(w, -50, 50);
    w->segments = once_in(w, 2) ? 1 : draw(w, 2, 4);
    line(w, "segments %d", w->segments);
    write_anchors(w);
    char text[200];
    int n = snprintf(text, sizeof text, "ticks");
    for (int i = 0; i < w->segments; i++) {
        const int64_t start = tick + draw(w, 0, 9) * draw(w, 0, 1), end = start + draw(w, i + 1 == w->segments ? 0 : 1, 60);
        n += snprintf(text + n, sizeof text - (size_t)n, " %lld %lld", (long long)start, (long long)end);
        tick = end;
    }
    line(w, "%s", text);
    if (once_in(w, 2))
        line(w, "reach %d %d %d", edgy(w, 0, 40), edgy(w, 0, 80), edgy(w, 0, 80));
    if (once_in(w, 3))
        line(w, "timebase %d %d", draw(w, 1, 2000), draw(w, 1, 90000));
    if (w->segments > 1)
        line(w, "share %s", draw(w, 0, 2) ? (draw(w, 0, 1) ? "all" : "none") : "E_Sigma F_theta Z E_fg0");
}

/** Outputs of a network: priors, other integers, binary32. */
typedef enum net_form { PRIOR, INTEGERS, BINARY32 } net_form;

static void write_network(writer *w, const char *role, net_form form, int layers_max)
{
    char residual[40] = "0";
    const int layers = edgy(w, 1, layers_max);
    size_t n = 1;
    for (int i = 1; i < layers; i++)
        n += (size_t)snprintf(residual + n, sizeof residual - n, ",%d", i + 1 < layers && once_in(w, 3));
    line(w, "net %s layers=%d width=%d,%d residual=%s", role, layers, edgy(w, 1, 24), draw(w, 1, 24), residual);
    if (form != BINARY32)
        line(w, "net %s in_shift=%d shift=%d,%d,%d limit=%d bias=20000", role, edgy(w, 0, 8), draw(w, 3, 9), draw(w, 3, 10),
             edgy(w, 0, 24), draw(w, 1, 40));
    if (form == PRIOR)
        line(w, "net %s sigma_shift=%d sigma_offset=%d", role, edgy(w, 4, 24),
             once_in(w, 4) ? edgy(w, -64, 127) : draw(w, 0, 40));
    else if (form == BINARY32)
        line(w, "net %s e=%d bias_e=%d mode=%d bias_mode=%d", role, draw(w, 5, 12), draw(w, 5, 12), once_in(w, 4), once_in(w, 4));
}

/* E_fv (which has one layer if it has no inputs) and F_varpi keep their default shapes. */
static void write_networks(writer *w)
{
    static const char *const fg[] = {"E_fg0", "E_fg1", "E_fg2", "E_fg3"};
    write_network(w, "E_Sigma", PRIOR, 8);
    write_network(w, "E_C", PRIOR, 8);
    if (w->adaptive)
        write_network(w, "E_q", INTEGERS, 8);
    for (int i = 0; i < w->chunks && w->n_fg > 0; i++)
        write_network(w, fg[i], PRIOR, 4);
    write_network(w, "F_theta", BINARY32, 4);
    if (w->moving)
        write_network(w, "F_omega", BINARY32, 4);
    if (w->moving && once_in(w, 5))
        line(w, "net %s absent=1", draw(w, 0, 1) ? "F_omega" : "F_varpi");
}

static void write_values(writer *w)
{
    static const char *const fills[] = {"paint", "paint", "random", "zero", "edges", "escapes", "clips"};
    static const char *const picks[] = {"random", "random", "random", "all", "none", "first", "turns"};
    static const char *const groups[] = {"fv", "sigma", "colour", "fg"};
    line(w, "values %s", fills[draw(w, 0, COUNT(fills) - 1)]);
    line(w, "masks %s", picks[draw(w, 0, COUNT(picks) - 1)]);
    line(w, "static %s", picks[draw(w, 0, COUNT(picks) - 1)]);
    line(w, "bodies %s", picks[draw(w, 0, COUNT(picks) - 1)]);
    for (int i = 0; i < COUNT(groups); i++)
        if (once_in(w, 3))
            line(w, "steps %s %d 0x1.%xp-%d", groups[i], draw(w, 0, 3), (unsigned)draw(w, 0, 0xfffff), draw(w, 6, 13));
}

static void write_rest(writer *w)
{
    static const double sizes[][2] = {{24, 16}, {17, 13}, {1, 1}, {40, 5}};
    for (int i = 0; i < 2; i++) {
        const double *const size = sizes[draw(w, 0, COUNT(sizes) - 1)];
        line(w, "camera c%d %g %g %d %d.5 %g %g 0.%02d 1 0 0 %g 0 1 0 %g 0 0 1 %g", i, size[0], size[1], draw(w, 5, 40),
             draw(w, 5, 40), size[0] * draw(w, 0, 4) / 2, size[1] / 2, draw(w, 1, 99), draw(w, -8, 8) / 8.0, draw(w, -8, 8) / 8.0,
             -4.0 + draw(w, 0, 5) * draw(w, 0, 1));
    }
    line(w, "times %g %g %g", draw(w, -60, 300) / 1000.0, draw(w, 0, 99) / 1000.0, draw(w, 0, 1) ? 1e9 : -1.0);
    if (once_in(w, 4))
        line(w, "stored a 20 16 25 25 10 8 0.01 1 0 0 %g 0 1 0 0 0 0 1 -4%s", draw(w, 0, 9) / 10.0,
             once_in(w, 2) ? " time=0.25" : "");
    if (once_in(w, 4))
        line(w, "meta title times=%d \"a b\"", draw(w, 0, 60));
    if (once_in(w, 4))
        line(w, "screen_filter 0.%d", draw(w, 0, 9));
    if (once_in(w, 4))
        line(w, "scene_scale %d.5", draw(w, 0, 3));
}

static void write_edits(writer *w)
{
    const int slices = ((w->anchors - 1) >> w->slice_log2) + 1;
    if (once_in(w, 6))
        line(w, "remove hash");
    if (w->segments > 1 && once_in(w, 4))
        line(w, "remove INDX");
    if (once_in(w, 6))
        line(w, "set HEAD.segments 0");
    if (once_in(w, 6))
        line(w, "set HEAD.duration_ticks -1");
    if (once_in(w, 6))
        line(w, "insert note %s GEOM zeros=%d", draw(w, 0, 1) ? "before" : "after", draw(w, 0, 99));
    if (once_in(w, 8))
        line(w, "insert HEAD after GEOM copy=HEAD");
    if (once_in(w, 8))
        line(w, "insert NETW after GEOM copy=NETW");
    if (slices > 1 && !w->tiered && once_in(w, 3))
        line(w, "split FEA0 %d", draw(w, 1, slices - 1));
    if (w->n_fg > 0 && once_in(w, 5))
        line(w, slices > 1 && !w->tiered && once_in(w, 2) ? "keep FEA%d 1" : "remove FEA%d", w->chunks);
    if (once_in(w, 8))
        line(w, "tail 00112233");
}

adcgs_status adcgs_random_recipe(adcgs_recipe *out, uint64_t seed, FILE *text, adcgs_error *error)
{
    writer w = {.recipe = out, .text = text, .state = seed, .status = ADCGS_OK, .error = error};
    *out = (adcgs_recipe){.n = 0};
    snprintf(out->id, sizeof out->id, "seed %llu", (unsigned long long)seed);
    line(&w, "seed %llu", (unsigned long long)seed);
    write_params(&w);
    write_geometry(&w);
    write_segments(&w);
    write_networks(&w);
    write_values(&w);
    write_rest(&w);
    write_edits(&w);
    return w.status;
}
