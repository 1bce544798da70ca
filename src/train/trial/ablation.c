/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Ablation: the parts of the method that a run leaves out for comparison. */
#include "train/settings.h"

/** Makes each primitive an anchor of its own. */
static void leave_out_anchors(adcgs_train_config *c)
{
    c->start_anchors = (uint32_t)ADCGS_MIN((uint64_t)c->start_anchors * c->params.k, ADCGS_ANCHORS_MAX);
    c->max_anchors = (uint32_t)ADCGS_MIN((uint64_t)c->max_anchors * c->params.k, ADCGS_ANCHORS_MAX);
    c->detail_anchors *= (float)c->params.k;
    c->params.k = c->params.chunks = 1;
    c->params.n_fg = 0;
}

/* Bits of the parts that a run leaves out; definition. */
enum { COARSE = 1, FINE = 2, RATE = 4, DENSIFICATION = 8, ANCHORS = 16, WEIGHT_STEPS = 32, REMOVAL = 64 };

static void leave_out(adcgs_train_config *c, int bits)
{
    c->without_coarse = (bits & COARSE) != 0;
    c->without_fine = (bits & FINE) != 0;
    c->without_rate = (bits & RATE) != 0;
    c->without_densification = (bits & DENSIFICATION) != 0;
    c->without_weight_steps = (bits & WEIGHT_STEPS) != 0;
    if (bits & ANCHORS)
        leave_out_anchors(c);
    if (bits & REMOVAL) {
        c->prune_units_at = c->prune_at = 2;
        c->static_threshold = 0; /* static anchors are detected before prune_at */
    }
    if (bits & DENSIFICATION)
        c->start_anchors = c->max_anchors;
}

adcgs_status adcgs_train_leave_out(adcgs_train_config *c, const char *parts, adcgs_error *error)
{
    /* The last two are earlier names of parts. */
    static const struct {
        const char *name;
        int bits;
    } known[] = {{"none", 0},
                 {"coarse", COARSE},
                 {"fine", FINE},
                 {"deformation", COARSE | FINE},
                 {"rate", RATE},
                 {"densification", DENSIFICATION},
                 {"anchors", ANCHORS},
                 {"weight_steps", WEIGHT_STEPS},
                 {"removal", REMOVAL},
                 {"refinement", DENSIFICATION},
                 {"lattice", WEIGHT_STEPS}};
    int bits = 0;
    for (const char *at = parts;; at++) {
        const size_t length = strcspn(at, ",");
        size_t i = 0;
        while (i < ADCGS_COUNTOF(known) && (strlen(known[i].name) != length || memcmp(known[i].name, at, length) != 0))
            i++;
        if (i == ADCGS_COUNTOF(known))
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "cannot leave out '%.*s': expected none, coarse, fine, deformation, rate, densification, anchors, "
                              "removal or weight_steps",
                              (int)length, at);
        bits |= known[i].bits;
        at += length;
        if (!*at)
            break;
    }
    leave_out(c, bits);
    return ADCGS_OK;
}
