/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Mechanisms that follow from the scene. */
#include "train/trial/mechanisms.h"

#include <string.h>

const char *const adcgs_mechanism_names[ADCGS_MECHANISMS] = {
    [ADCGS_MATCHING] = "matching",
    [ADCGS_GAINS] = "gains",
    [ADCGS_BLACK_LEVELS] = "black_levels",
    [ADCGS_LIFETIMES] = "lifetimes",
    [ADCGS_BODIES] = "bodies",
    [ADCGS_SQUARES] = "squares",
    [ADCGS_SCALE_PRICE] = "scale_price",
    [ADCGS_RETIMING] = "retiming",
    [ADCGS_RESIDUALS] = "residuals",
    [ADCGS_FLOATERS] = "floaters",
    [ADCGS_STATIC_ANCHORS] = "static_anchors",
};

const char *const adcgs_mechanism_settings[ADCGS_MECHANISMS] = {
    [ADCGS_MATCHING] = "matching_frames",
    [ADCGS_GAINS] = "gains",
    [ADCGS_BLACK_LEVELS] = "black_levels",
    [ADCGS_LIFETIMES] = "lifetimes",
    [ADCGS_BODIES] = "bodies",
    [ADCGS_SQUARES] = "l2_share",
    [ADCGS_SCALE_PRICE] = "scale_reg_weight",
    [ADCGS_RETIMING] = "retime_duplicates",
    [ADCGS_RESIDUALS] = "residual_densify",
    [ADCGS_FLOATERS] = "prune_floaters",
    [ADCGS_STATIC_ANCHORS] = "static_threshold",
};

int adcgs_mechanism_is_dropped(int mechanism, const char *trials)
{
    static const char key[] = " dropped=";
    const char *const name = adcgs_mechanism_names[mechanism], *at = strstr(trials, key);
    for (at = at ? at + sizeof key - 1 : ""; *at; at += *at == ',') {
        const size_t length = strcspn(at, ", ");
        if (length == strlen(name) && !memcmp(at, name, length))
            return 1;
        at += length;
        if (*at == ' ')
            break;
    }
    return 0;
}
