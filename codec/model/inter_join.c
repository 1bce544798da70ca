/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splitting a model into kept anchors of the previous one and new anchors, and joining them. */
#include "geom/geom.h"
#include "model/inter_priv.h"
#include "model/model_priv.h"

static void copy_kept(adcgs_model *to, uint32_t i, const adcgs_inter *kept, const adcgs_model *from, uint32_t j)
{
    adcgs_anchor_copy(to, i, from, j);
    for (int g = 0; g < ADCGS_INTER_GROUPS; g++) {
        const size_t n = (size_t)adcgs_inter_channels(&to->params, g);
        memcpy(adcgs_inter_rows(to, g) + i * n, kept->rows[g] + j * n, n * sizeof(int16_t));
    }
}

static int same_bytes(const void *a, const void *b, size_t bytes)
{
    return bytes == 0 || memcmp(a, b, bytes) == 0;
}

int adcgs_inter_possible(const adcgs_model *a, const adcgs_model *b, adcgs_error *why)
{
    const char *what = NULL;
    if (!adcgs_params_equal(&a->params, &b->params))
        what = "parameters";
    else if (a->depth != b->depth || !same_bytes(a->origin, b->origin, sizeof a->origin) ||
             !same_bytes(&a->voxel, &b->voxel, sizeof a->voxel))
        what = "grid";
    else if (!same_bytes(a->eta_mu, b->eta_mu, sizeof a->eta_mu) || !same_bytes(a->eta_si, b->eta_si, sizeof a->eta_si))
        what = "priors";
    else if (a->finest != b->finest || !same_bytes(a->growth, b->growth, a->finest * sizeof *a->growth))
        what = "tiers";
    else if (!same_bytes(a->d_fv, b->d_fv, a->params.n_fv * sizeof *a->d_fv) ||
             !same_bytes(a->d_sigma, b->d_sigma, (size_t)adcgs_sigma_rows(&a->params) * sizeof *a->d_sigma) ||
             !same_bytes(a->d_colour, b->d_colour, sizeof a->d_colour) ||
             !same_bytes(a->d_fg, b->d_fg, a->params.n_fg * sizeof *a->d_fg))
        what = "steps";
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (a->net[role].present && !b->net[role].present)
            what = "networks";
    if (what)
        adcgs_fail(why, ADCGS_ERR_USAGE, "stream: a predicted segment does not share the %s of the previous one", what);
    return !what;
}

/** Whether differences lead exactly from one latent to the other. */
static int within_reach(int32_t before, int32_t now)
{
    return adcgs_clip(before + 64 * adcgs_inter_difference(before, now), 32767) == now;
}

static adcgs_inter_mode mode_of(const adcgs_model *a, uint32_t i, const adcgs_model *b, uint32_t j)
{
    const size_t eta = a->params.n_eta, fg = (size_t)a->params.k * a->params.n_fg;
    if (a->is_static[i] != b->is_static[j] || a->body[i] != b->body[j] || a->mask[i] != b->mask[j] || a->tier[i] != b->tier[j] ||
        !same_bytes(a->eta + i * eta, b->eta + j * eta, eta * sizeof *a->eta) ||
        !same_bytes(a->fg + i * fg, b->fg + j * fg, fg * sizeof *a->fg))
        return ADCGS_INTER_DROPPED;
    adcgs_inter_mode mode = ADCGS_INTER_SAME;
    for (int g = 0; g < ADCGS_INTER_GROUPS; g++) {
        const size_t n = (size_t)adcgs_inter_channels(&a->params, g);
        const int16_t *before = adcgs_inter_rows(a, g) + i * n, *now = adcgs_inter_rows(b, g) + j * n;
        for (size_t c = 0; c < n; c++) {
            if (!within_reach(before[c], now[c]))
                return ADCGS_INTER_DROPPED;
            mode = before[c] != now[c] ? ADCGS_INTER_REFINED : mode;
        }
    }
    return mode;
}

adcgs_status adcgs_inter_find(adcgs_inter *kept, const adcgs_model *before, const adcgs_model *now, adcgs_error *error)
{
    ADCGS_TRY(adcgs_inter_alloc(kept, before, NULL, error));
    for (uint32_t i = 0, j = 0; i < before->n; i++) {
        while (j < now->n && adcgs_anchor_place(now, j) < adcgs_anchor_place(before, i))
            j++;
        kept->mode[i] = ADCGS_INTER_DROPPED;
        if (j == now->n || adcgs_anchor_place(now, j) != adcgs_anchor_place(before, i))
            continue;
        kept->mode[i] = (uint8_t)mode_of(before, i, now, j);
        kept->n += kept->mode[i] != ADCGS_INTER_DROPPED;
        for (int g = 0; kept->mode[i] == ADCGS_INTER_REFINED && g < ADCGS_INTER_GROUPS; g++) {
            const size_t n = (size_t)adcgs_inter_channels(&now->params, g);
            memcpy(kept->rows[g] + i * n, adcgs_inter_rows(now, g) + j * n, n * sizeof(int16_t));
        }
    }
    return ADCGS_OK;
}

/** Whether an anchor is kept at this place. i: index of the anchors before; calls must ask for places in ascending order. */
static int is_kept(const adcgs_inter *kept, const adcgs_model *before, uint32_t *i, uint64_t place)
{
    while (*i < before->n && (kept->mode[*i] == ADCGS_INTER_DROPPED || adcgs_anchor_place(before, *i) < place))
        ++*i;
    return *i < before->n && adcgs_anchor_place(before, *i) == place;
}

adcgs_status adcgs_inter_renew(adcgs_model *now, const adcgs_model *before, adcgs_error *error)
{
    adcgs_inter kept = {.n = 0};
    const adcgs_status status = adcgs_inter_find(&kept, before, now, error);
    uint32_t i = 0;
    for (uint32_t j = 0; status == ADCGS_OK && j < now->n; j++) {
        if (!is_kept(&kept, before, &i, adcgs_anchor_place(now, j)))
            now->tier[j] = 0;
    }
    adcgs_inter_clear(&kept, NULL);
    return status;
}

adcgs_status adcgs_inter_rest(adcgs_model *rest, const adcgs_inter *kept, const adcgs_model *before, const adcgs_model *now,
                              adcgs_error *error)
{
    *rest = adcgs_model_frame(now);
    rest->n = now->n - kept->n;
    ADCGS_TRY(adcgs_model_alloc(rest, NULL, error));
    ADCGS_TRY(adcgs_nets_copy(rest, now, NULL, error));
    uint32_t i = 0, n = 0;
    for (uint32_t j = 0; j < now->n; j++) {
        if (!is_kept(kept, before, &i, adcgs_anchor_place(now, j)))
            adcgs_anchor_copy(rest, n++, now, j);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_inter_model(adcgs_model *stay, const adcgs_inter *kept, const adcgs_model *before, adcgs_memory *memory,
                               adcgs_error *error)
{
    *stay = adcgs_model_frame(before);
    stay->n = kept->n;
    ADCGS_TRY(adcgs_model_alloc(stay, memory, error));
    for (uint32_t i = 0, n = 0; i < before->n; i++)
        if (kept->mode[i] != ADCGS_INTER_DROPPED)
            copy_kept(stay, n++, kept, before, i);
    return ADCGS_OK;
}
