/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Findings on a scene's footage, as lines of text with a kind. */
#ifndef ADCGS_CHECK_FINDINGS_H
#define ADCGS_CHECK_FINDINGS_H

#include "check/axes.h"
#include "check/faults.h"

/** Kinds of findings. */
typedef enum adcgs_finding_kind {
    ADCGS_FINDING_GAP,          /**< a camera, or all, have no image for a time */
    ADCGS_FINDING_TIMES,        /**< images without times that seem to be frames */
    ADCGS_FINDING_AXES,         /**< another convention fits the poses */
    ADCGS_FINDING_POSES,        /**< the cameras' images disagree with their poses */
    ADCGS_FINDING_POSE_OUTLIER, /**< those of a single camera do */
    ADCGS_FINDING_DUPLICATE,    /**< an image repeats the previous one of its camera */
    ADCGS_FINDING_COPY,         /**< an image repeats the previous one of another camera */
    ADCGS_FINDING_LIGHT,        /**< a step of brightness or colour */
    ADCGS_FINDING_CLOCK,        /**< a camera lags the others, or is ahead of them */
    ADCGS_FINDING_KINDS
} adcgs_finding_kind;

/** Names of the kinds for JSON: "gap", "times", "axes", ... */
extern const char *const adcgs_finding_names[ADCGS_FINDING_KINDS];

/** Most findings: one of each kind, except for single cameras; arithmetic. */
#define ADCGS_FINDINGS_MAX (ADCGS_FINDING_KINDS - 1 + ADCGS_POSE_OUTLIERS_MAX)

typedef struct adcgs_finding {
    adcgs_finding_kind kind;
    char *text; /**< one line with place, numbers and the action; names in it are not escaped */
} adcgs_finding;

/** Zero-initialise before use. */
typedef struct adcgs_findings {
    int n;
    adcgs_finding list[ADCGS_FINDINGS_MAX];
} adcgs_findings;

void adcgs_findings_clear(adcgs_findings *findings);

/*
 * Each function appends a finding. On allocation failure, and beyond ADCGS_FINDINGS_MAX, it appends nothing. scene: the whole
 * scene. begins: seconds at which the judged part begins in it.
 */
void adcgs_find_gap(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *fault);
void adcgs_find_times(adcgs_findings *findings, const adcgs_scene *scene);
void adcgs_find_axes(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_axes_check *axes);
void adcgs_find_poses(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_stereo_pose_error *poses);
/** path: of the camera's first view; pixels: of the original image per pixel of outlier->off. */
void adcgs_find_pose_outlier(adcgs_findings *findings, const adcgs_scene *scene, const char *path,
                             const adcgs_pose_outlier *outlier, double pixels);
void adcgs_find_duplicate(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *fault, double begins);
void adcgs_find_copy(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *fault, double begins);
/** is_evened: the step was removed from the images. */
void adcgs_find_light(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *fault, double begins, int is_evened);
void adcgs_find_clock(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *fault);

#endif
