/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The values of a recipe's models, coded while they are drawn: fills, and commands that force a value. */
#include "draw.h"

#include "base/cpu_detect.h"
#include "model/latents_priv.h"
#include "model/model_priv.h"
#include "stream/parts.h"

#include <stdlib.h>

/** A slice while its values are drawn at random and coded. */
typedef struct drawing {
    adcgs_plan *plan;
    const adcgs_model *model;
    adcgs_range_enc range;
    int turn; /**< counts values, for fills that alternate sign, length or distance */
} drawing;

static int group_index(int group)
{
    return ADCGS_MIN(group, ADCGS_GROUP_FG);
}

/* For a visible image: extents of e^-3.5 to e^-2.5, colours of 0 to 1, lives that may end within the segment; else small. */
static int32_t paint(drawing *w, const adcgs_latent_site *site, int c)
{
    const int channel = site->first + c, sigma = site->group == ADCGS_GROUP_SIGMA;
    if (!sigma && site->group != ADCGS_GROUP_COLOUR)
        return adcgs_draw_int(&w->plan->state, -2, 2);
    const double step = 64.0 * (double)(sigma ? w->model->d_sigma[channel] : w->model->d_colour[channel]);
    double wanted = adcgs_draw_int(&w->plan->state, 0, 1000) / 1000.0;
    if (sigma)
        wanted = channel == ADCGS_SPAN_PACE ? 2 * wanted : channel >= ADCGS_SIGMA_N ? 8 * wanted - 4 : wanted - 3.5;
    return (int32_t)(wanted / step - site->mu[c] / 64.0);
}

/* The index n of a value; the caller limits it to the values that can be coded. */
static int32_t choose(drawing *w, const adcgs_latent_site *site, int c, int si)
{
    const int32_t support = adcgs_table_support(si), turn = w->turn++, sign = turn & 1 ? -1 : 1;
    const int prefix = turn / 2 % 16;
    switch (w->plan->values) {
    case ADCGS_FILL_RANDOM:
        return adcgs_draw_int(&w->plan->state, 0, 99) ? adcgs_draw_int(&w->plan->state, -1 - si / 8, 1 + si / 8)
                                                      : adcgs_draw_int(&w->plan->state, -700, 700);
    case ADCGS_FILL_ZERO:
        return 0;
    case ADCGS_FILL_EDGES:
        return sign * (support + (turn / 2 & 1));
    case ADCGS_FILL_ESCAPES:
        return sign * (support + (1 << prefix) + adcgs_draw_int(&w->plan->state, 0, (1 << prefix) - 1));
    case ADCGS_FILL_CLIPS:
        return sign * (32767 - sign * site->mu[c] + 63 * (turn / 2 % 3)) / 64;
    default:
        return paint(w, site, c);
    }
}

/** For commands "force": the place of a value, and the value after these commands. */
typedef struct forced {
    const adcgs_latent_site *site;
    int c, si;
    int32_t n;
} forced;

static int word_is_index(const char *word, int index)
{
    return strcmp(word, "*") == 0 || atoi(word) == index;
}

/* force GROUP ANCHOR K CHANNEL VALUE; numbers or *, and VALUE also as [-]max, [-]edge, [-]escape. */
static adcgs_status force(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    static const char *const groups[] = {"eta", "fv", "sigma", "colour", "fg", NULL};
    static const char *const names[] = {"max", "edge", "escape", NULL};
    forced *const f = user;
    int group, name;
    int64_t value;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 5, 5, error));
    ADCGS_TRY(adcgs_word_choice(c->word[1], groups, &group, error));
    if (group != group_index(f->site->group) || !word_is_index(c->word[2], (int)f->site->anchor) ||
        (f->site->k >= 0 && !word_is_index(c->word[3], f->site->k)) || !word_is_index(c->word[4], f->site->first + f->c))
        return ADCGS_OK;
    const int negative = c->word[5][0] == '-';
    const int32_t support = adcgs_table_support(f->si);
    if (adcgs_word_choice(c->word[5] + negative, names, &name, NULL) == ADCGS_OK) {
        f->n = name == 0 ? adcgs_value_max(f->si) : support + (name == 2);
        f->n = negative ? -f->n : f->n;
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_word_int(c->word[5], -100000, 100000, &value, error));
    f->n = (int32_t)value;
    return ADCGS_OK;
}

static void draw_site(void *user, const adcgs_latent_site *site)
{
    drawing *const w = user;
    for (int c = 0; c < site->count; c++) {
        const int si = site->si[c];
        forced f = {site, c, si, 0};
        if (si > 0) {
            const int32_t most = adcgs_value_max(si);
            f.n = choose(w, site, c, si);
            adcgs_plan_each(w->plan, "force", force, &f, NULL); /* adcgs_draw_check() has checked the commands */
            f.n = adcgs_clip(f.n, most);
            adcgs_value_enc(&w->range, si, f.n);
        }
        site->yq[c] = (int16_t)adcgs_clip(64 * f.n + site->mu[c], 32767);
    }
}

static int draw_flag(void *user, adcgs_adaptive *context, int bit)
{
    drawing *const w = user;
    adcgs_adaptive_enc(&w->range, context, bit);
    return bit;
}

adcgs_status adcgs_draw_slices(adcgs_plan *plan, adcgs_model *m, adcgs_drawn_tier *out, adcgs_error *error)
{
    const uint32_t slice = 1U << plan->stream.slice_log2;
    const int layers = adcgs_params_layers(&m->params);
    adcgs_latents *latents = NULL;
    drawing w = {.plan = plan, .model = m};
    out->n_slices = m->n ? ((m->n - 1) >> plan->stream.slice_log2) + 1 : 0;
    out->data = adcgs_alloc(NULL, ADCGS_LAYERS * out->n_slices, sizeof *out->data, error);
    if (!out->data)
        return ADCGS_ERR_MEMORY;
    adcgs_status status = adcgs_latents_create(&latents, m, ADCGS_CPU_SCALAR, NULL, error);
    for (uint32_t i = 0; i < (uint32_t)layers * out->n_slices && status == ADCGS_OK; i++) {
        const int layer = (int)(i / out->n_slices);
        const uint32_t begin = i % out->n_slices * slice, end = begin + ADCGS_MIN(m->n - begin, slice);
        adcgs_range_enc_init(&w.range, &out->data[i]);
        if (layer == 0)
            status = adcgs_latents_flags(m, begin, end, draw_flag, &w, error);
        if (status == ADCGS_OK)
            status = adcgs_latents_walk(latents, m, layer, begin, end, draw_site, &w, NULL);
        adcgs_range_enc_finish(&w.range);
    }
    adcgs_latents_free(&latents);
    return status;
}

adcgs_status adcgs_draw_check(adcgs_plan *plan, adcgs_error *error)
{
    const adcgs_latent_site nowhere = {.k = 0, .group = ADCGS_GROUP_ETA};
    forced f = {.site = &nowhere, .si = 1};
    return adcgs_plan_each(plan, "force", force, &f, error);
}
