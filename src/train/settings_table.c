/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * All settings, one row each: name and field, effects, range, values in the presets draft, fast, medium, slow and paper, and one
 * line of help: a noun phrase with unit and default. COMMON rows are for users, others for research. Lists, the man page and
 * doc/settings.md have the same order. Preset paper follows the sizes and the schedule of the published method (Huang et al.
 * 2025, ADC-GS, IJCAI; section 4.1, appendix A), without coarse-to-fine.
 */
#include "train/settings.h"

#include "init/stereo.h"
#include "net/net.h"
#include "train/team/tree_sum.h"

#include <stddef.h>

const char *const adcgs_train_presets[] = {"draft", "fast", "medium", "slow", "paper", NULL};

/* clang-format off */
#define KIND(field)                                                                                                \
    _Generic(((adcgs_train_config *)0)->field, float : ADCGS_SETTING_REAL, int : ADCGS_SETTING_INT,                \
             uint32_t : ADCGS_SETTING_UINT32, uint64_t : ADCGS_SETTING_UINT64, uint16_t : ADCGS_SETTING_UINT16,    \
             uint8_t : ADCGS_SETTING_UINT8)
/* clang-format on */
#define AT(field) offsetof(adcgs_train_config, field)

#define S ADCGS_AFFECTS_SPEED
#define B ADCGS_AFFECTS_BYTES
#define Q ADCGS_AFFECTS_QUALITY
#define M ADCGS_AFFECTS_MEMORY
#define WIDTH_MAX ADCGS_NET_WIDTH_MAX
/* clang-format off */
#define ALL(x) { x, x, x, x, x }
#define BUT_PAPER(x, paper) { x, x, x, x, paper }

/* A row: most settings bind a run from the start. */
#define ENTRY(class, name, field, group, fixed, affects, min, max, ...)                                                      \
    { name, KIND(field), AT(field), ADCGS_SETTING_##class, ADCGS_SETTING_##group, ADCGS_FIXED_##fixed, affects, min, max,      \
      __VA_ARGS__ }
/* clang-format on */
#define ROW(...) ENTRY(RESEARCH, __VA_ARGS__)
#define COMMON(name, field, group, ...) ENTRY(COMMON, #name, field, group, ALWAYS, __VA_ARGS__)
#define RUN(name, ...) ROW(#name, name, RUN, ALWAYS, __VA_ARGS__)
#define LOSS(name, ...) ROW(#name, name, LOSS, ALWAYS, __VA_ARGS__)
#define MODEL(name, ...) ROW(#name, params.name, MODEL, ALWAYS, __VA_ARGS__)
#define NETWORK(name, ...) ROW(#name, shape.name, NETWORKS, ALWAYS, __VA_ARGS__)
#define STEP(name, ...) ROW(#name, shape.name, STEPS, ALWAYS, __VA_ARGS__)
#define ANCHOR(name, ...) ROW(#name, name, ANCHORS, ALWAYS, __VA_ARGS__)
#define TIME(name, affects, max, ...) ROW(#name, name, TIMES, ALWAYS, affects, 0, max, __VA_ARGS__)
#define SWITCH(name, fixed, help) ROW(#name, name, SWITCHES, fixed, 0, 0, 1, ALL(0), help)

const adcgs_setting adcgs_settings[] = {
    COMMON(iterations, iterations, RUN, S | Q, 10, 1e7, {3000, 20000, 40000, 100000, 80000},
           "iterations of the run, each one optimiser step"),
    COMMON(batch, batch, RUN, S | Q | M, 1, ADCGS_TREE_MOST, ALL(1),
           "images of an iteration, whose mean gradient gives one optimiser step"),
    COMMON(seed, seed, RUN, 0, 0, 1e15, ALL(1), "seed of every random choice"),
    RUN(lr_scale_anchors, Q, 0, 100, ALL(1), "factor of the learning rates of features, extents, colours and hyperprior"),
    RUN(lr_scale_prediction, Q, 0, 100, ALL(1), "factor of the learning rate of F_theta"),
    RUN(lr_scale_motion, Q, 0, 100, ALL(1), "factor of the learning rates of F_omega, F_varpi and the time table"),
    RUN(lr_scale_entropy, B | Q, 0, 100, ALL(1), "factor of the learning rates of quantiser steps, priors and entropy networks"),
    RUN(retime_duplicates, Q, 0, 1, BUT_PAPER(1, 0),
        "0 or 1: a duplicated image is trained at the timestamp of the image that it repeats"),
    RUN(exposure_step_compensation, Q, 0, 1, ALL(0),
        "0 or 1: steps in the brightness or tint of a camera's images are evened out"),
    COMMON(trial_share, trial_share, RUN, S | Q, 0, 1, BUT_PAPER(0.02, 0),
           "iterations of each trial before the run, relative to the run's; below 100 iterations: no trials"),
    COMMON(gains, gains, RUN, Q, 0, 1, ALL(1),
           "0 or 1: a gain for each camera, and for each image of a static scene, during training"),
    COMMON(black_levels, black_levels, RUN, Q, 0, 1, ALL(1), "0 or 1: a black level for each camera during training"),
    COMMON(scale, scale, RUN, S | Q | M, 1, 64, ALL(1),
           "divisor of the images' width and height; by default larger for images of over 1600 pixels"),

    /*
     * Rate in the loss: Balle et al. 2017, End-to-end optimized image compression, ICLR. Choice of levels by rate and distortion:
     * Ramchandran and Vetterli 1994, IEEE Trans. Image Processing 3(5). SSIM in the loss: Kerbl et al. 2023, 3D Gaussian
     * splatting, SIGGRAPH. Rigidity between neighbours: Sorkine and Alexa 2007, As-rigid-as-possible surface modeling, SGP;
     * Luiten et al. 2024, Dynamic 3D Gaussians, 3DV. Scale penalty: Lombardi et al. 2021, Mixture of volumetric primitives,
     * SIGGRAPH; Lu et al. 2024, Scaffold-GS, CVPR. Dropout: Srivastava et al. 2014, JMLR 15.
     */
    ENTRY(COMMON, "lambda", lambda, LOSS, WITH_LAMBDA, B | Q, 0, 1000, ALL(0.1),
          "loss per mebibyte of features and networks; larger means smaller files; default times the images' contrast / 0.22"),
    LOSS(network_rate, B | Q, 0, 1000, BUT_PAPER(1, 0), "weight of the networks' bits, relative to those of features"),
    LOSS(rate_period, S | Q, 1, 1000, ALL(4),
         "interval of the groups of 64 anchors whose bits are measured in an iteration; 1: all groups"),
    COMMON(ssim_weight, ssim_weight, LOSS, Q, 0, 1, ALL(0.2),
           "share of 1 - SSIM in the photometric loss; the rest is error per pixel"),
    ROW("l2_share", l2_share, LOSS, ALWAYS, Q, 0, 1, BUT_PAPER(0.9, 0),
        "share of squares in the error per pixel, the rest is L1; by default at most 0.5 if one camera sees each frame"),
    ROW("rigidity_weight", rigidity_weight, LOSS, ALWAYS, S | Q, 0, 1000, BUT_PAPER(0.02, 0),
        "weight of the rigidity regulariser between neighbouring anchors; by default 0 if several views share a timestamp"),
    LOSS(scale_reg_weight, S | Q, 0, 1000, BUT_PAPER(0.02, 0), "weight of the scale regulariser"),
    LOSS(tier_weight, S | B | Q, 0, 10, BUT_PAPER(0.03, 0), "weight of the photometric loss of renders without later tiers"),
    COMMON(dropout, dropout, LOSS, Q, 0, 0.9, BUT_PAPER(0.1, 0),
           "share of primitives dropped at random until rounding, against overfitting few views"),

    /* Anchors: Lu et al. 2024; K primitives each, deformed by two networks: ADC-GS. eta is a hyperprior: Balle et al. 2018, ICLR.
     * Octaves of sines: Mildenhall et al. 2020, NeRF, ECCV. */
    COMMON(k, params.k, MODEL, S | B | Q | M, 1, ADCGS_K_MAX, BUT_PAPER(6, 10), "primitives per anchor"),
    MODEL(n_fv, S | B | Q | M, 1, ADCGS_NV_MAX, ALL(32), "features of an anchor (f_v)"),
    MODEL(n_fg, S | B | Q | M, 0, ADCGS_NG_MAX, {0, 8, 8, 8, 16},
          "features of each primitive (f_g), a multiple of chunks; 0: none"),
    MODEL(chunks, B | Q, 1, ADCGS_CHUNKS_MAX, ALL(4), "parts of f_g, coded one after the other: the layers of a stream"),
    MODEL(n_eta, B | Q, 0, ADCGS_ETA_MAX, ALL(4), "hyperprior values of an anchor (eta)"),
    MODEL(octaves, S | Q, 0, ADCGS_OCTAVES_MAX, ALL(5), "octaves of the position encoding of an anchor"),
    MODEL(fine_uses_fv, S | B | Q, 0, 1, ALL(1), "0 or 1: the fine deformation reads f_v"),
    MODEL(coarse_rotation, S | B | Q, 0, 1, ALL(1), "0 or 1: the coarse deformation includes rotation"),
    MODEL(adaptive_steps, S | B | Q, 0, 1, ALL(0), "0 or 1: a network predicts each anchor's quantiser steps"),
    COMMON(lifetimes, params.spans, MODEL, S | B | Q, 0, 1, BUT_PAPER(1, 0),
           "0 or 1: moving anchors have lifetimes; off if matching finds no motion"),
    COMMON(bodies, params.bodies, MODEL, B | Q, 0, ADCGS_BODIES_MAX, BUT_PAPER(8, 0),
           "maximum number of rigid bodies; as many exist as matching finds"),
    MODEL(time_rows, B | Q, 0, ADCGS_TIME_ROWS_MAX, ALL(40), "rows of the time table, at most one per timestamp; 0: no motion"),
    ROW("smooth_time", params.smooth_time, MODEL, ALWAYS, Q, 0, 1, BUT_PAPER(1, 0),
        "0 or 1: a spline interpolates the time table; by default off if half of the cameras or more see each frame"),
    MODEL(time_width, S | B | Q, 0, ADCGS_TIME_WIDTH_MAX, BUT_PAPER(16, 64), "values in a row of the time table"),

    NETWORK(theta_width, S | B | Q | M, 1, WIDTH_MAX, ALL(32),
            "hidden width of F_theta, which predicts primitives from features"),
    NETWORK(theta_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_theta"),
    NETWORK(omega_width, S | B | Q | M, 0, WIDTH_MAX, BUT_PAPER(48, 128),
            "hidden width of F_omega, the coarse deformation; 0: none"),
    NETWORK(omega_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_omega"),
    NETWORK(varpi_width, S | B | Q | M, 0, WIDTH_MAX, BUT_PAPER(48, 128),
            "hidden width of F_varpi, the fine deformation; 0: none"),
    NETWORK(varpi_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_varpi"),
    NETWORK(entropy_width, S | B | M, 1, WIDTH_MAX, BUT_PAPER(24, 32), "hidden width of the entropy networks"),
    NETWORK(entropy_hidden, S | B, 1, 3, BUT_PAPER(1, 2), "hidden layers of the entropy networks"),

    STEP(depth, B | Q, 4, 21, ALL(11), "bits per axis of the anchors' grid"),
    STEP(step_fv, B | Q, 1e-4, 10, ALL(0.1), "initial quantiser step of f_v; it is trained"),
    STEP(step_fg, B | Q, 1e-4, 10, ALL(0.1), "initial quantiser step of f_g; it is trained"),
    STEP(step_sigma, B | Q, 1e-4, 10, ALL(0.06), "initial quantiser step of extents; it is trained"),
    STEP(step_colour, B | Q, 1e-4, 10, ALL(0.02), "initial quantiser step of colours; it is trained"),

    /* Densification: Kerbl et al. 2023; by temporal significance: ADC-GS, section 3.5. */
    ROW("start_anchors", start_anchors, ANCHORS, ALWAYS, S | Q, 1, ADCGS_ANCHORS_MAX, {600, 1000, 1000, 1000, 1000},
        "initial number of anchors; by default at least 3/4 of max_anchors with points or matched images"),
    COMMON(max_anchors, max_anchors, ANCHORS, S | B | Q | M, 1, ADCGS_ANCHORS_MAX, {1200, 6000, 8000, 10000, 20000},
           "maximum number of anchors; by default from detail_anchors"),
    COMMON(detail_anchors, detail_anchors, ANCHORS, S | B | Q | M, 0, 10000, BUT_PAPER(50, 0),
           "ratio of max_anchors, unless given, to the square root of the details per image; 0: the preset's max_anchors"),
    COMMON(tiers, tiers, ANCHORS, S | B | Q, 1, ADCGS_TIERS_MAX, BUT_PAPER(4, 1),
           "maximum number of tiers: sets of anchors that are sent one after the other and add detail"),
    COMMON(matching_frames, matching_frames, ANCHORS, S | Q, 0, ADCGS_MATCHING_FRAMES_MAX, ALL(ADCGS_MATCHING_FRAMES_MAX),
           "maximum number of frames matched for first anchors and motion; 0: no matching"),
    ANCHOR(lifetime_frames, B | Q, 0.1, 1e4, ALL(3),
           "initial lifetime of an anchor before and after its own frame, in matched frames"),
    ANCHOR(lifetime_trim, Q, 0, 1, BUT_PAPER(1, 0), "0 or 1: a lifetime also ends where most cameras show the background"),
    ANCHOR(residual_densify, Q, 0, 1, ALL(1), "0 or 1: anchors are also added where several views miss light"),
    ANCHOR(prune_floaters, Q, 0, 1, ALL(1), "0 or 1: static primitives in space that matching found empty are pruned"),
    ANCHOR(densify_interval, S | Q, 1, 1e6, ALL(100), "iterations between densifications"),
    ANCHOR(densify_threshold, S | B | Q, 0, 1e6, ALL(0.0003),
           "screen gradient, weighted by temporal significance, above which anchors grow"),
    ANCHOR(prune_opacity, S | B | Q, 0, 1, ALL(0.02),
           "opacity of an anchor's most opaque primitive below which the anchor is pruned"),
    ANCHOR(min_mean_opacity, S | B | Q, 0, 1, BUT_PAPER(0.04, 0),
           "minimum mean opacity of primitives at prune_at; fainter ones are pruned, at most a tenth of the rendered weight"),
    ANCHOR(static_threshold, S | B | Q, 0, 1e6, BUT_PAPER(1, 0),
           "effect of time below which an anchor becomes static; 1 is just visible"),

    /*
     * Curriculum: Bengio et al. 2009, ICML. Coarse to fine: Girish et al. 2024, EAGLES, ECCV. Noise in place of rounding: Balle
     * et al. 2017. Averages of the last iterations: Izmailov et al. 2018, Averaging weights, UAI.
     */
    TIME(curriculum_begin, S | Q, 1, ALL(0.1), "share of the views that training begins with, around the middle of time"),
    TIME(curriculum_until, S | Q, 2, BUT_PAPER(0.25, 0), "fraction of training from which all views are trained"),
    TIME(lr_decay_start, S | Q, 2, BUT_PAPER(0.3, 0), "fraction of training at which learning rates begin to decay"),
    TIME(quarter_size_until, S | Q, 2, BUT_PAPER(0.25, 0),
         "fraction of training up to which images have a quarter of their size"),
    TIME(half_size_until, S | Q, 2, BUT_PAPER(0.7, 0), "fraction of training up to which images have half of their size"),
    TIME(deform_start, S | Q, 2, BUT_PAPER(0.01, 0.1), "fraction of training from which the scene is deformed over time"),
    TIME(densify_start, S | B | Q, 2, BUT_PAPER(0.03, 0.0125),
         "fraction of training from which anchors are densified and pruned"),
    TIME(densify_until, S | B | Q, 2, BUT_PAPER(0.5, 0.3125), "fraction of training at which densification ends"),
    TIME(quant_noise_start, B | Q, 2, BUT_PAPER(0.25, 0.125), "fraction of training from which noise stands for rounding"),
    TIME(rate_start, B | Q, 2, BUT_PAPER(0.3, 0.125), "fraction of training from which the features' bits count in the loss"),
    ROW("scale_reg_start", scale_reg_start, TIMES, ALWAYS, S | Q, 0, 2, ALL(0.3),
        "fraction of training from which the scale regulariser counts; 0 in dynamic scenes if several views share a timestamp"),
    TIME(fine_start, S | Q, 2, BUT_PAPER(0.35, 0.1), "fraction of training from which the fine deformation is applied"),
    TIME(prune_units_at, S | B | Q, 2, BUT_PAPER(0.52, 2),
         "fraction of training at which hidden units not worth their bits are pruned, and networks' bits begin to count"),
    TIME(prune_units_again, S | B | Q, 2, ALL(0.76), "fraction of training at which such hidden units are pruned again"),
    TIME(prune_at, S | B | Q, 2, ALL(0.52),
         "fraction of training at which unused primitives are pruned and unmoved anchors become static"),
    TIME(tiers_start, B | Q, 2, ALL(0.6), "fraction of training at which anchors are sorted into tiers, not before prune_at"),
    TIME(quant_round_start, B | Q, 2, ALL(0.85), "fraction of training from which values and weights are rounded"),
    TIME(freeze_start, B | Q, 2, ALL(0.96), "fraction of training from which values are final and networks alone are trained"),
    TIME(average_share, Q, 1, BUT_PAPER(0.05, 0),
         "fraction of training over which parameters are averaged, before freezing and before the end"),

    SWITCH(without_coarse, ALWAYS, "no coarse deformation"),
    SWITCH(without_fine, ALWAYS, "no fine deformation"),
    SWITCH(without_rate, ALWAYS, "no rate in the loss"),
    SWITCH(without_densification, ALWAYS, "no densification, no pruning"),
    SWITCH(without_weight_steps, WITH_ROUNDING, "rendering networks with weights of 32 bits"),
    SWITCH(without_rounding, ALWAYS, "values and weights of 32 bits to the end"),
    SWITCH(bf16, ALWAYS, "rendering networks trained in bf16"),
    {.name = NULL},
};
_Static_assert(ADCGS_COUNTOF(adcgs_settings) <= ADCGS_SETTINGS_MAX, "a configuration records the origin of each row");

const adcgs_setting_former adcgs_settings_former[] = {
    {"average_last", "average_share"},
    {"decide_at", "prune_at"},
    {"deform_from", "deform_start"},
    {"densify_every", "densify_interval"},
    {"densify_from", "densify_start"},
    {"even_light", "exposure_step_compensation"},
    {"fine_from", "fine_start"},
    {"freeze_from", "freeze_start"},
    {"half_until", "half_size_until"},
    {"keep_opacity", "min_mean_opacity"},
    {"learn_entropy", "lr_scale_entropy"},
    {"learn_features", "lr_scale_anchors"},
    {"learn_motion", "lr_scale_motion"},
    {"learn_prediction", "lr_scale_prediction"},
    {"noise_from", "quant_noise_start"},
    {"quarter_until", "quarter_size_until"},
    {"rate_from", "rate_start"},
    {"rates_fall_from", "lr_decay_start"},
    {"retime_doubled", "retime_duplicates"},
    {"rigid_weight", "rigidity_weight"},
    {"round_from", "quant_round_start"},
    {"scale_from", "scale_reg_start"},
    {"scale_weight", "scale_reg_weight"},
    {"span_ends", "lifetime_trim"},
    {"span_moments", "lifetime_frames"},
    {"spans", "lifetimes"},
    {"square_weight", "l2_share"},
    {"stereo", "matching_frames"},
    {"still_below", "static_threshold"},
    {"tiers_from", "tiers_start"},
    {NULL, NULL},
};
