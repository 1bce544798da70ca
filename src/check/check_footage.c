/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks of footage before training. */
#include "config.h"

#include "check/check_footage.h"

/* Pixels along the shorter side of images for thumbnails: each cell has several; chosen by hand, not measured. */
enum { SIDE = 2 * ADCGS_THUMBNAIL_SIDE };

/** True the first time that it is asked for a kind. */
static int is_new(unsigned *known, adcgs_finding_kind kind)
{
    const unsigned bit = 1u << kind, before = *known;
    *known |= bit;
    return !(before & bit);
}

static int is_known(const unsigned *known, adcgs_finding_kind kind)
{
    return (*known & 1u << kind) != 0;
}

static void check_poses(adcgs_findings *findings, const adcgs_footage_facts *facts, const adcgs_scene *whole, adcgs_pool *pool,
                        unsigned *known)
{
    const adcgs_stereo *const found = facts->matched;
    adcgs_axes_check axes;
    adcgs_error error;
    /* Axes are checked for the first part of a scene. */
    if (is_new(known, ADCGS_FINDING_AXES) && adcgs_axes_check_run(&axes, facts->scene, found, pool, &error) == ADCGS_OK &&
        axes.meant != ADCGS_READ_AS_GIVEN) {
        adcgs_find_axes(findings, whole, &axes);
        *known |= 1u << ADCGS_FINDING_POSES;
    }
    if (!is_known(known, ADCGS_FINDING_POSES) && found->poses.pairs >= ADCGS_STEREO_PAIRS &&
        !adcgs_stereo_poses_fit(&found->poses)) {
        adcgs_find_poses(findings, whole, &found->poses);
        *known |= 1u << ADCGS_FINDING_POSES;
    }
    for (int i = 0; i < found->n_outliers && !is_known(known, ADCGS_FINDING_POSES); i++)
        adcgs_find_pose_outlier(findings, facts->scene, facts->scene->views[ADCGS_SPLIT_TRAIN][found->outlier[i].view].path,
                                &found->outlier[i], found->poses.pixels);
}

static void check_images(adcgs_findings *findings, const adcgs_footage_facts *facts, const adcgs_scene *whole,
                         const adcgs_camera_order *order, unsigned *known)
{
    const adcgs_scene_view *const views = facts->scene->views[ADCGS_SPLIT_TRAIN];
    const adcgs_thumbnail *const thumbnails = facts->thumbnails;
    adcgs_fault f;
    adcgs_error error;
    if (!is_known(known, ADCGS_FINDING_DUPLICATE)) {
        adcgs_fault_duplicates(&f, NULL, views, order, thumbnails);
        if (f.cameras && is_new(known, ADCGS_FINDING_DUPLICATE))
            adcgs_find_duplicate(findings, whole, &f, facts->begins);
    }
    if (!is_known(known, ADCGS_FINDING_COPY) && adcgs_fault_copied(&f, views, order, thumbnails, &error) == ADCGS_OK &&
        f.cameras && is_new(known, ADCGS_FINDING_COPY))
        adcgs_find_copy(findings, whole, &f, facts->begins);
    if (!is_known(known, ADCGS_FINDING_LIGHT) && adcgs_fault_light(&f, NULL, views, order, thumbnails, &error) == ADCGS_OK &&
        f.cameras && is_new(known, ADCGS_FINDING_LIGHT))
        adcgs_find_light(findings, whole, &f, facts->begins, 0);
    if (!is_known(known, ADCGS_FINDING_CLOCK) && adcgs_fault_clocks(&f, views, order, thumbnails, &error) == ADCGS_OK &&
        f.cameras && is_new(known, ADCGS_FINDING_CLOCK))
        adcgs_find_clock(findings, whole, &f);
}

void adcgs_check_footage(adcgs_findings *findings, const adcgs_footage_facts *facts, adcgs_pool *pool, unsigned *known)
{
    const adcgs_scene *const scene = facts->scene, *const whole = scene->whole ? scene->whole : scene;
    adcgs_fault gaps;
    adcgs_camera_order order;
    adcgs_error error;
    /* The first two are checks of the whole scene. */
    if (is_new(known, ADCGS_FINDING_GAP) && adcgs_fault_gaps(&gaps, whole, &error) == ADCGS_OK && gaps.cameras)
        adcgs_find_gap(findings, whole, &gaps);
    if (is_new(known, ADCGS_FINDING_TIMES) && whole->counts)
        adcgs_find_times(findings, whole);
    check_poses(findings, facts, whole, pool, known);
    if (adcgs_camera_order_find(&order, scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN], &error) != ADCGS_OK)
        return;
    check_images(findings, facts, whole, &order, known);
    adcgs_camera_order_clear(&order);
}

/** The largest factor of reduction that leaves SIDE pixels along the shorter side of each image; at least 1. */
static int divide_for(const adcgs_scene *scene)
{
    int side = 0;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const adcgs_camera *const camera = &scene->views[ADCGS_SPLIT_TRAIN][i].camera;
        const int shorter = ADCGS_MIN(camera->width, camera->height);
        side = side ? ADCGS_MIN(side, shorter) : shorter;
    }
    return ADCGS_MAX(side / SIDE, 1);
}

adcgs_status adcgs_thumbnails_load(adcgs_thumbnail *thumbnails, const adcgs_scene *scene, const adcgs_image_store_config *config,
                                   adcgs_pool *pool, adcgs_error *error)
{
    adcgs_image_store *pictures;
    adcgs_image_store_config small = *config;
    small.split = ADCGS_SPLIT_TRAIN;
    small.divide = divide_for(scene);
    small.thumbnails = thumbnails;
    const adcgs_status status = adcgs_image_store_load(&pictures, scene, &small, pool, error);
    adcgs_image_store_free(&pictures);
    return status;
}
