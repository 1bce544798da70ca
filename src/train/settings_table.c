/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * All settings, one row each: name and field, effects, range, values in the presets draft, fast, medium, slow and paper, and one
 * line of help. Lists and the man page have the same order. Preset paper follows the sizes and the schedule of the published
 * method (Huang et al. 2025, ADC-GS, IJCAI; section 4.1, appendix A), without coarse-to-fine.
 */
#include "train/settings.h"

#include "net/net.h"
#include "stereo/stereo.h"
#include "train/tree_sum.h"

#include <stddef.h>

const char *const adcgs_train_presets[] = { "draft", "fast", "medium", "slow", "paper", NULL };

#define KIND(field)                                                                                                \
    _Generic(((adcgs_train_config *)0)->field, float : ADCGS_SETTING_REAL, int : ADCGS_SETTING_INT,                \
             uint32_t : ADCGS_SETTING_UINT32, uint64_t : ADCGS_SETTING_UINT64, uint16_t : ADCGS_SETTING_UINT16,    \
             uint8_t : ADCGS_SETTING_UINT8)
#define AT(field) offsetof(adcgs_train_config, field)

#define S ADCGS_TRADES_SPEED
#define B ADCGS_TRADES_BYTES
#define Q ADCGS_TRADES_QUALITY
#define M ADCGS_TRADES_MEMORY
#define WIDTH_MAX ADCGS_NET_WIDTH_MAX
#define ALL(x) { x, x, x, x, x }
#define BUT_PAPER(x, paper) { x, x, x, x, paper }

/* A row: most settings bind a run from the start, and nothing depends on whether the user set them. */
#define ROW(name, field, own, group, binds, trades, min, max, ...) \
    { name, KIND(field), AT(field), own, ADCGS_SETTING_##group, ADCGS_BINDS_##binds, trades, min, max, __VA_ARGS__ }
#define RUN(name, ...) ROW(#name, name, 0, RUN, ALWAYS, __VA_ARGS__)
#define LOSS(name, ...) ROW(#name, name, 0, LOSS, ALWAYS, __VA_ARGS__)
#define MODEL(name, ...) ROW(#name, params.name, 0, MODEL, ALWAYS, __VA_ARGS__)
#define NETWORK(name, ...) ROW(#name, shape.name, AT(own_networks), NETWORKS, ALWAYS, __VA_ARGS__)
#define STEP(name, ...) ROW(#name, shape.name, 0, STEPS, ALWAYS, __VA_ARGS__)
#define ANCHOR(name, ...) ROW(#name, name, 0, ANCHORS, ALWAYS, __VA_ARGS__)
#define MOMENT(name, trades, max, ...) ROW(#name, name, 0, MOMENTS, ALWAYS, trades, 0, max, __VA_ARGS__)
#define SWITCH(name, binds, help) ROW(#name, name, 0, SWITCHES, binds, 0, 0, 1, ALL(0), help)

const adcgs_setting adcgs_settings[] = {
    RUN(iterations, S | Q, 10, 1e7, { 3000, 20000, 40000, 100000, 80000 }, "iterations of the run, each one step"),
    RUN(batch, S | Q | M, 1, ADCGS_TREE_MOST, ALL(1),
        "pictures that an iteration looks at: it is one step, by the mean of their gradients"),
    RUN(seed, 0, 0, 1e15, ALL(1), "seed of every random choice"),
    RUN(learn_features, Q, 0, 100, ALL(1), "learning rates of the anchors' values, times this"),
    RUN(learn_prediction, Q, 0, 100, ALL(1), "learning rate of F_theta, times this"),
    RUN(learn_motion, Q, 0, 100, ALL(1), "learning rates of F_omega, F_varpi and the time table, times this"),
    RUN(learn_entropy, B | Q, 0, 100, ALL(1), "learning rates of quantiser steps, priors and entropy networks, times this"),
    RUN(retime_doubled, Q, 0, 1, BUT_PAPER(1, 0), "1: a picture that is the one before once more is learnt as of its time"),
    RUN(even_light, Q, 0, 1, ALL(0), "1: where the light of a camera's pictures steps, those behind are learnt in that before"),
    RUN(trial_share, S | Q, 0, 1, BUT_PAPER(0.02, 0),
        "iterations of each trial that judges a mechanism before the run, over the run's; fewer than 100: none"),
    RUN(gains, Q, 0, 1, ALL(1), "1: cameras, and images of a static scene, have a gain each while the scene is trained"),
    RUN(black_levels, Q, 0, 1, ALL(1), "1: cameras have a black level each while the scene is trained"),
    RUN(scale, S | Q | M, 1, 64, ALL(1), "the pictures' width and height are divided by this"),

    /*
     * Rate in the loss: Balle et al. 2017, End-to-end optimized image compression, ICLR. Choice of levels by rate and distortion:
     * Ramchandran and Vetterli 1994, IEEE Trans. Image Processing 3(5). SSIM in the loss: Kerbl et al. 2023, 3D Gaussian
     * splatting, SIGGRAPH. Rigidity between neighbours: Sorkine and Alexa 2007, As-rigid-as-possible surface modeling, SGP;
     * Luiten et al. 2024, Dynamic 3D Gaussians, 3DV. Scale penalty: Lombardi et al. 2021, Mixture of volumetric primitives,
     * SIGGRAPH; Lu et al. 2024, Scaffold-GS, CVPR. Dropout: Srivastava et al. 2014, JMLR 15.
     */
    ROW("lambda", lambda, AT(own_lambda), LOSS, WITH_LAMBDA, B | Q, 0, 1000, ALL(0.1),
        "loss per mebibyte of features and networks, more makes smaller files; unless given, in proportion to contrast"),
    LOSS(network_rate, B | Q, 0, 1000, BUT_PAPER(1, 0), "weight of the networks' own bits, relative to those of features"),
    LOSS(rate_period, S | Q, 1, 1000, ALL(4), "bits are measured on one group of 64 anchors in so many"),
    LOSS(rdo_strength, B | Q, 0, 1000, ALL(0), "weight of bits when levels are chosen, relative to lambda; 0: nearest levels"),
    LOSS(ssim_weight, Q, 0, 1, ALL(0.2), "share of 1 - SSIM in the pictures' loss; the rest is errors"),
    ROW("square_weight", square_weight, AT(own_square), LOSS, ALWAYS, Q, 0, 1, BUT_PAPER(0.9, 0),
        "share of squares in that rest, L1 is what is left; unless given, at most 0.5 where one camera sees a moment"),
    ROW("rigid_weight", rigid_weight, AT(own_rigid), LOSS, ALWAYS, S | Q, 0, 1000, BUT_PAPER(0.02, 0),
        "neighbours move alike; unless given, 0 where several views share a moment"),
    LOSS(scale_weight, S | Q, 0, 1000, BUT_PAPER(0.02, 0), "price of the primitives' size"),
    LOSS(distortion_weight, Q, 0, 1000, ALL(0),
         "price of depth's spread along rays; 0.001 where few cameras are learnt by heart"),
    LOSS(distortion_period, S | Q, 1, 1000, ALL(4), "that spread is measured in one iteration of so many"),
    LOSS(tier_weight, S | B | Q, 0, 10, BUT_PAPER(0.03, 0), "weight of the pictures' loss while tiers are absent"),
    LOSS(dropout, Q, 0, 0.9, BUT_PAPER(0.1, 0), "share of primitives left out at random, against overfitting few views"),

    /* Anchors: Lu et al. 2024; K primitives each, deformed by two networks: ADC-GS. eta is a hyperprior: Balle et al. 2018, ICLR.
     * Octaves of sines: Mildenhall et al. 2020, NeRF, ECCV. */
    MODEL(k, S | B | Q | M, 1, ADCGS_K_MAX, BUT_PAPER(6, 10), "primitives per anchor"),
    MODEL(n_fv, S | B | Q | M, 1, ADCGS_NV_MAX, ALL(32), "features of an anchor (f_v)"),
    MODEL(n_fg, S | B | Q | M, 0, ADCGS_NG_MAX, { 0, 8, 8, 8, 16 },
          "features of each primitive (f_g), a multiple of chunks; 0: none"),
    MODEL(chunks, B | Q, 1, ADCGS_CHUNKS_MAX, ALL(4), "parts of f_g, coded one after the other: the layers of a stream"),
    MODEL(n_eta, B | Q, 0, ADCGS_ETA_MAX, ALL(4), "hyperprior values of an anchor (eta)"),
    MODEL(octaves, S | Q, 0, ADCGS_OCTAVES_MAX, ALL(5), "octaves of the code of an anchor's position"),
    MODEL(fine_uses_fv, S | B | Q, 0, 1, ALL(1), "1: the fine deformation sees f_v"),
    MODEL(coarse_rotation, S | B | Q, 0, 1, ALL(1), "1: the coarse deformation rotates, too"),
    MODEL(adaptive_steps, S | B | Q, 0, 1, ALL(0), "1: a network predicts each anchor's quantiser steps"),
    MODEL(spans, S | B | Q, 0, 1, BUT_PAPER(1, 0), "1: what moves has spans of life, unless matching finds nothing"),
    MODEL(bodies, B | Q, 0, ADCGS_BODIES_MAX, BUT_PAPER(8, 0), "rigid bodies, at most, where matching finds any"),
    MODEL(time_rows, B | Q, 0, ADCGS_TIME_ROWS_MAX, ALL(40), "rows of the time table, at most one per moment; 0: no motion"),
    ROW("smooth_time", params.smooth_time, AT(own_smooth), MODEL, ALWAYS, Q, 0, 1, BUT_PAPER(1, 0),
        "1: time passes along a spline of these rows; unless given, where less than half of the cameras see a moment"),
    MODEL(time_width, S | B | Q, 0, ADCGS_TIME_WIDTH_MAX, BUT_PAPER(16, 64), "values in a row of the time table"),

    NETWORK(theta_width, S | B | Q | M, 1, WIDTH_MAX, ALL(32), "hidden width of F_theta, which makes primitives of features"),
    NETWORK(theta_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_theta"),
    NETWORK(omega_width, S | B | Q | M, 0, WIDTH_MAX, BUT_PAPER(48, 128), "hidden width of F_omega, coarse deformation; 0: none"),
    NETWORK(omega_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_omega"),
    NETWORK(varpi_width, S | B | Q | M, 0, WIDTH_MAX, BUT_PAPER(48, 128), "hidden width of F_varpi, fine deformation; 0: none"),
    NETWORK(varpi_hidden, S | B | Q, 1, 3, ALL(2), "hidden layers of F_varpi"),
    NETWORK(entropy_width, S | B | M, 1, WIDTH_MAX, BUT_PAPER(24, 32), "hidden width of the entropy networks"),
    NETWORK(entropy_hidden, S | B, 1, 3, BUT_PAPER(1, 2), "hidden layers of the entropy networks"),

    STEP(depth, B | Q, 4, 21, ALL(11), "bits per axis of the grid of anchors"),
    STEP(step_fv, B | Q, 1e-4, 10, ALL(0.1), "quantiser step of f_v to begin with; it is learned"),
    STEP(step_fg, B | Q, 1e-4, 10, ALL(0.1), "quantiser step of f_g to begin with"),
    STEP(step_sigma, B | Q, 1e-4, 10, ALL(0.06), "quantiser step of extents to begin with"),
    STEP(step_colour, B | Q, 1e-4, 10, ALL(0.02), "quantiser step of colours to begin with"),

    /* Densification: Kerbl et al. 2023; by temporal significance: ADC-GS, section 3.5. */
    ROW("start_anchors", start_anchors, AT(own_start), ANCHORS, ALWAYS, S | Q, 1, ADCGS_ANCHORS_MAX,
        { 600, 1000, 1000, 1000, 1000 },
        "anchors to begin with; unless given, at least 3/4 of max_anchors where pictures are matched"),
    ROW("max_anchors", max_anchors, AT(own_anchors), ANCHORS, ALWAYS, S | B | Q | M, 1, ADCGS_ANCHORS_MAX,
        { 1200, 6000, 8000, 10000, 20000 }, "budget of anchors; unless given, see detail_anchors"),
    ANCHOR(detail_anchors, S | B | Q | M, 0, 10000, BUT_PAPER(50, 0),
           "max_anchors over the square root of a picture's details, unless that is given; 0: the preset's"),
    ANCHOR(tiers, S | B | Q, 1, ADCGS_TIERS_MAX, BUT_PAPER(4, 1),
           "sets of anchors that are sent one after the other, each with finer detail, at most"),
    ANCHOR(stereo, S | Q, 0, ADCGS_STEREO_MOMENTS, ALL(ADCGS_STEREO_MOMENTS),
           "moments at most that pictures are matched of, for first anchors and motion; 0: none"),
    ANCHOR(span_moments, B | Q, 0.1, 1e4, ALL(3), "moments before and after its own that an anchor with a span begins with"),
    ANCHOR(span_ends, Q, 0, 1, BUT_PAPER(1, 0), "1: but it ends where most cameras show what is behind it"),
    ANCHOR(residual_densify, Q, 0, 1, ALL(1), "1: anchors are added where several views miss light, too"),
    ANCHOR(prune_floaters, Q, 0, 1, ALL(1), "1: static primitives in space that matching found empty are pruned"),
    ANCHOR(densify_every, S | Q, 1, 1e6, ALL(100), "iterations from one densification to the next"),
    ANCHOR(densify_threshold, S | B | Q, 0, 1e6, ALL(0.0003),
           "screen gradient, weighted by temporal significance, at which anchors grow"),
    ANCHOR(prune_opacity, S | B | Q, 0, 1, ALL(0.02), "anchors whose primitives are all of less opacity go"),
    ANCHOR(keep_opacity, S | B | Q, 0, 1, BUT_PAPER(0.04, 0),
           "primitives of less opacity in the mean go at decide_at, a tenth of what is drawn at most"),
    ANCHOR(still_below, S | B | Q, 0, 1e6, BUT_PAPER(1, 0),
           "effect of time, 1 can just be seen, below which an anchor becomes static"),

    /*
     * Curriculum: Bengio et al. 2009, ICML. Coarse to fine: Girish et al. 2024, EAGLES, ECCV. Noise in place of rounding: Balle
     * et al. 2017. Averages of the last iterations: Izmailov et al. 2018, Averaging weights, UAI.
     */
    MOMENT(curriculum_begin, S | Q, 1, ALL(0.1), "share of views, about the middle of time, that training begins with"),
    MOMENT(curriculum_until, S | Q, 2, BUT_PAPER(0.25, 0), "all views are trained on from here"),
    MOMENT(rates_fall_from, S | Q, 2, BUT_PAPER(0.3, 0), "learning rates stay as they are until here, then fall"),
    MOMENT(quarter_until, S | Q, 2, BUT_PAPER(0.25, 0), "pictures have a quarter of their size until here"),
    MOMENT(half_until, S | Q, 2, BUT_PAPER(0.7, 0), "pictures have half of their size until here"),
    MOMENT(deform_from, S | Q, 2, BUT_PAPER(0.01, 0.1), "the scene moves from here"),
    MOMENT(densify_from, S | B | Q, 2, BUT_PAPER(0.03, 0.0125), "anchors are densified and pruned from here"),
    MOMENT(densify_until, S | B | Q, 2, BUT_PAPER(0.5, 0.3125), "densification ends here"),
    MOMENT(noise_from, B | Q, 2, BUT_PAPER(0.25, 0.125), "noise stands for rounding from here"),
    MOMENT(rate_from, B | Q, 2, BUT_PAPER(0.3, 0.125), "bits of features count from here"),
    ROW("scale_from", scale_from, AT(own_scale_from), MOMENTS, ALWAYS, S | Q, 0, 2, ALL(0.3),
        "size has its price from here; unless given, 0 where several views share a moment"),
    MOMENT(fine_from, S | Q, 2, BUT_PAPER(0.35, 0.1), "the fine deformation takes part from here"),
    MOMENT(prune_units_at, S | B | Q, 2, BUT_PAPER(0.52, 2), "hidden units that do not pay go; networks' bits count from here"),
    MOMENT(prune_units_again, S | B | Q, 2, ALL(0.76), "hidden units that do not pay go once more"),
    MOMENT(decide_at, S | B | Q, 2, ALL(0.52), "primitives that never matter go, anchors that never move become static"),
    MOMENT(tiers_from, B | Q, 2, ALL(0.6), "anchors are sorted into tiers, behind decide_at"),
    MOMENT(round_from, B | Q, 2, ALL(0.85), "values and weights are rounded from here"),
    MOMENT(freeze_from, B | Q, 2, ALL(0.96), "values are final from here, networks alone are trained"),
    MOMENT(average_last, Q, 1, BUT_PAPER(0.05, 0), "so much of the ends of rounding and of the run is averaged"),

    SWITCH(without_coarse, ALWAYS, "no coarse deformation"),
    SWITCH(without_fine, ALWAYS, "no fine deformation"),
    SWITCH(without_rate, ALWAYS, "no rate in the loss"),
    SWITCH(without_densification, ALWAYS, "no densification, no pruning"),
    SWITCH(without_weight_steps, WITH_ROUNDING, "weights of 32 bits in the networks that draw"),
    SWITCH(without_rounding, ALWAYS, "values and weights of 32 bits to the end"),
    SWITCH(bf16, ALWAYS, "networks that draw are trained in bf16"),
    { .name = NULL },
};
