/* SPDX-License-Identifier: BSD-2-Clause */
/** \file All decisions on settings that the request leaves open. */
#include "train/resolve.h"

#include "train/rate/rate_plan.h"
#include "train/stage_table.h"

#include <math.h>
#include <stddef.h>

/*
 * Minimum of max_anchors by details; chosen by hand, not measured. The rule above it is calibrated (doc/log/anchors.md, "Grid of
 * anchor numbers").
 */
#define DETAIL_ANCHORS_LEAST 100
/* Maximum l2_share if one camera sees each frame; calibrated on synth_robot_dnerf and nrnerf_hand (doc/log/training.md). */
#define SQUARE_ALONE 0.5f
/* Of max_anchors, if there are points; calibrated on llff_fern and zju313_15f (doc/log/initialisation.md). */
#define START_SHARE 0.75
/* The same for splats as a scene, which show all content; calibrated on biker, plyseq and stg_lite (doc/log/splats.md). */
#define SPLATS_START_SHARE 0.98

/* Densification intervals per trial; chosen by hand, not measured. */
#define TRIAL_DENSIFICATIONS 20

static const char *const deciders[ADCGS_DECIDERS] =
    {[ADCGS_BY_PRESET] = "preset", [ADCGS_BY_USER] = "user",     [ADCGS_BY_SCENE] = "scene",   [ADCGS_BY_MATCHING] = "matching",
     [ADCGS_BY_TRIAL] = "trial",   [ADCGS_BY_TARGET] = "target", [ADCGS_BY_EFFORT] = "effort", [ADCGS_BY_SEGMENTS] = "segments"};

/* ---- The record ---- */

/** Records a decision. The first one keeps the requested value. */
static void record(adcgs_train_config *c, const adcgs_setting *s, double before, double used, adcgs_decider by,
                   const char *reason)
{
    adcgs_setting_origin *const o = &c->origin[s - adcgs_settings];
    if (!o->reason)
        o->requested = before;
    o->by = (uint8_t)by;
    o->used = used;
    o->reason = reason;
}

/** Sets a value, and records a change. */
static void decide(adcgs_train_config *c, const char *name, double value, adcgs_decider by, const char *reason)
{
    const adcgs_setting *const s = adcgs_setting_find(name);
    const double before = adcgs_setting_get(s, c);
    if (before == value)
        return;
    adcgs_setting_put(s, c, value);
    record(c, s, before, adcgs_setting_get(s, c), by, reason);
}

/** The same, unless the user gave the setting. */
static void decide_open(adcgs_train_config *c, const char *name, double value, adcgs_decider by, const char *reason)
{
    if (!adcgs_setting_is_given(c, name))
        decide(c, name, value, by, reason);
}

int adcgs_resolve_next(const adcgs_train_config *c, size_t *row, adcgs_resolution *out)
{
    for (; adcgs_settings[*row].name; ++*row) {
        const adcgs_setting_origin *const o = &c->origin[*row];
        if (!o->reason || o->used == o->requested)
            continue;
        *out = (adcgs_resolution){&adcgs_settings[*row], o->requested, o->used, deciders[o->by], o->reason};
        ++*row;
        return 1;
    }
    return 0;
}

/* ---- Before a run ---- */

void adcgs_resolve_size(adcgs_train_config *c, int divisor)
{
    decide_open(c, "scale", divisor, ADCGS_BY_SCENE, "the images are larger than training can use");
}

void adcgs_resolve_trials(adcgs_train_config *c, const uint8_t dropped[ADCGS_MECHANISMS])
{
    for (int m = 0; m < ADCGS_MECHANISMS; m++)
        if (dropped[m])
            decide(c, adcgs_mechanism_settings[m], 0, ADCGS_BY_TRIAL, "held-back images are better without it");
}

void adcgs_resolve_trial(adcgs_train_config *c, const adcgs_trial_facts *f)
{
    static const char is_short[] = "a trial is a short run", is_small[] = "a trial uses small images";
    c->time_limit = 0;
    c->target = ADCGS_TARGET_NONE;
    decide(c, "iterations", f->iterations, ADCGS_BY_TRIAL, is_short);
    decide(c, "densify_interval", ADCGS_MAX(f->iterations / TRIAL_DENSIFICATIONS, 1), ADCGS_BY_TRIAL, is_short);
    decide(c, "batch", 1, ADCGS_BY_TRIAL, is_short);
    decide(c, "tiers", 1, ADCGS_BY_TRIAL, "a trial writes no stream");
    decide(c, "seed", (double)f->seed, ADCGS_BY_TRIAL, "a second trial needs another seed");
    if (f->reduction >= 1) {
        decide(c, "scale", fmin(c->scale * f->reduction, adcgs_setting_find("scale")->max), ADCGS_BY_TRIAL, is_small);
        decide(c, "half_size_until", ADCGS_STAGE_NEVER, ADCGS_BY_TRIAL, is_small);
    }
    if (f->without >= 0)
        decide(c, adcgs_mechanism_settings[f->without], 0, ADCGS_BY_TRIAL, "this trial leaves it out");
}

void adcgs_resolve_parts(adcgs_train_config *c, uint32_t times)
{
    decide(c, "time_rows", ADCGS_MIN(c->params.time_rows, times), ADCGS_BY_SEGMENTS,
           "the shortest segment has no more timestamps");
}

void adcgs_resolve_whole(adcgs_train_config *c, uint32_t parts)
{
    decide(c, "iterations", c->iterations * parts, ADCGS_BY_SEGMENTS, "as many as all segments together");
}

void adcgs_resolve_live(adcgs_train_config *c)
{
    decide(c, "detail_anchors", 0, ADCGS_BY_SEGMENTS, "the stream begins before most images arrive");
}

void adcgs_resolve_key(adcgs_train_config *c, uint16_t rows)
{
    decide(c, "time_rows", rows, ADCGS_BY_SEGMENTS, "keys have the parameters of the first segment");
}

void adcgs_resolve_delay(adcgs_train_config *c, int frames)
{
    decide(c, "matching_frames", ADCGS_MIN(c->matching_frames, frames), ADCGS_BY_EFFORT, "segments are due soon");
    decide(c, "bodies", 0, ADCGS_BY_EFFORT, "segments are due soon");
}

void adcgs_resolve_effort(adcgs_train_config *c, uint32_t iterations, double time_limit)
{
    decide(c, "iterations", iterations, ADCGS_BY_EFFORT, "as many as the time until the segment is due allows");
    c->time_limit = time_limit;
}

/* ---- When a run begins ---- */

/** Deformations that the user left out have no networks, and without both there is no motion. */
static void leave_out(adcgs_train_config *c)
{
    if (c->without_coarse && c->without_fine)
        decide(c, "time_rows", 0, ADCGS_BY_USER, "deformation is left out");
    if (c->without_coarse)
        decide(c, "omega_width", 0, ADCGS_BY_USER, "coarse deformation is left out");
    if (c->without_fine)
        decide(c, "varpi_width", 0, ADCGS_BY_USER, "fine deformation is left out");
}

/**
 * The time table has at most a row per timestamp. It uses a spline if less than half of the cameras see a frame on average. The
 * spline supplies content that a frame does not show from adjacent frames. Where most cameras see each frame, the frames suffice,
 * and a spline would blur sudden changes. All parts of a scene have the choice of the whole scene.
 */
static void resolve_time(adcgs_train_config *c, const adcgs_scene_facts *f)
{
    static const char *const of_time[] = {"time_width", "lifetimes", "bodies", "smooth_time"};
    if (f->times <= 1)
        decide(c, "time_rows", 0, ADCGS_BY_SCENE, "it has one timestamp");
    else
        decide(c, "time_rows", ADCGS_MIN(c->params.time_rows, f->times), ADCGS_BY_SCENE, "it has no more timestamps");
    for (size_t i = 0; !c->params.time_rows && i < ADCGS_COUNTOF(of_time); i++)
        decide(c, of_time[i], 0, ADCGS_BY_SCENE, "nothing moves without a time table");
    if (!f->is_sparse)
        decide_open(c, "smooth_time", 0, ADCGS_BY_SCENE, "half of the cameras or more see each frame");
}

/**
 * A single camera finds motion first by large primitives and by the motion of neighbours. Squared errors make it overfit frames
 * that it cannot explain. With several cameras, one frame suffices. In static scenes that cameras filmed from inside, small
 * primitives leave holes early in training, which then stay.
 */
static void resolve_loss(adcgs_train_config *c, const adcgs_scene_facts *f)
{
    static const char shared[] = "several views share a timestamp";
    if (f->is_shared)
        decide_open(c, "rigidity_weight", 0, ADCGS_BY_SCENE, shared);
    if (f->is_shared && f->times > 1)
        decide_open(c, "scale_reg_start", 0, ADCGS_BY_SCENE, shared);
    if (!f->is_shared && f->times > 1)
        decide_open(c, "l2_share", (double)fminf(c->l2_share, SQUARE_ALONE), ADCGS_BY_SCENE, "one camera sees each frame");
}

void adcgs_resolve_scene(adcgs_train_config *c, const adcgs_scene_facts *facts)
{
    leave_out(c);
    resolve_time(c, facts);
    resolve_loss(c, facts);
}

int adcgs_resolve_wants_details(const adcgs_train_config *c)
{
    return !adcgs_setting_is_given(c, "max_anchors") && c->detail_anchors > 0;
}

void adcgs_resolve_anchors(adcgs_train_config *c, uint32_t details)
{
    if (!adcgs_resolve_wants_details(c))
        return;
    const double anchors = fmin(fmax((double)c->detail_anchors * sqrt(details), DETAIL_ANCHORS_LEAST), ADCGS_ANCHORS_MAX);
    decide(c, "max_anchors", floor(anchors), ADCGS_BY_SCENE, "by the details of the images");
    decide(c, "start_anchors", ADCGS_MIN(c->start_anchors, c->max_anchors), ADCGS_BY_SCENE, "at most max_anchors");
}

adcgs_status adcgs_resolve_target(adcgs_train_config *c, adcgs_error *error)
{
    static const char fits[] = "it fits into the size";
    adcgs_rate_plan plan;
    ADCGS_TRY(adcgs_rate_plan_make(&plan, c, error));
    decide(c, "lambda", (double)plan.lambda, ADCGS_BY_TARGET, "where the search begins");
    decide(c, "theta_width", plan.shape.theta_width, ADCGS_BY_TARGET, fits);
    decide(c, "omega_width", plan.shape.omega_width, ADCGS_BY_TARGET, fits);
    decide(c, "varpi_width", plan.shape.varpi_width, ADCGS_BY_TARGET, fits);
    decide(c, "entropy_width", plan.shape.entropy_width, ADCGS_BY_TARGET, fits);
    decide(c, "max_anchors", plan.max_anchors, ADCGS_BY_TARGET, fits);
    decide(c, "start_anchors", plan.start_anchors, ADCGS_BY_TARGET, "at most max_anchors");
    return ADCGS_OK;
}

void adcgs_resolve_start(adcgs_train_config *c, int splats)
{
    const uint32_t least = (uint32_t)((splats ? SPLATS_START_SHARE : START_SHARE) * c->max_anchors);
    decide_open(c, "start_anchors", ADCGS_MAX(c->start_anchors, least), ADCGS_BY_SCENE, "there are points to begin with");
}

void adcgs_resolve_matching(adcgs_train_config *c, int moves, int bodies)
{
    if (!moves)
        decide(c, "lifetimes", 0, ADCGS_BY_MATCHING, "it found no motion");
    if (bodies >= 0)
        decide(c, "bodies", bodies, ADCGS_BY_MATCHING, "it found as many");
}

void adcgs_resolve_previous(adcgs_train_config *c, const adcgs_params *params)
{
    const adcgs_train_config before = *c;
    c->params = *params;
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        const double was = adcgs_setting_get(s, &before), is = adcgs_setting_get(s, c);
        if (was != is)
            record(c, s, was, is, ADCGS_BY_SEGMENTS, "the previous segment's");
    }
}

double adcgs_resolve_contrast(adcgs_train_config *c, double factor)
{
    const adcgs_setting *const s = adcgs_setting_find("lambda");
    const double lambda = (double)c->lambda * (adcgs_setting_is_given(c, "lambda") ? 1 : factor);
    if (lambda != (double)c->lambda)
        record(c, s, (double)c->lambda, lambda, ADCGS_BY_SCENE, "by the contrast of the images");
    return lambda;
}
