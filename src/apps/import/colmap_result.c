/* SPDX-License-Identifier: BSD-2-Clause */
/** \file COLMAP's result. */
#include "config.h"

#include "apps/import/colmap_result.h"

#include "geometry/rotation.h"
#include "scene/layouts/colmap_files.h"
#include "system/paths.h"

#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define POSED_LEAST 3    /* least number of views to train on */
#define STANDING_LEAST 2 /* least number of fixed cameras */

void adcgs_poses_clear(adcgs_poses *poses)
{
    adcgs_colmap_clear(&poses->model);
    free(poses->posed);
    *poses = (adcgs_poses){0};
}

static adcgs_status no_memory(const adcgs_import_job *job)
{
    return adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->folder);
}

/* ---- The largest model ---- */

/** Reads cameras and images of the model in sparse/NUMBER; place->folder is NULL if there is none. */
static adcgs_status read_model(adcgs_colmap *model, adcgs_colmap_place *place, const adcgs_import_job *job, uint32_t number)
{
    char *folder = adcgs_path("%s/sparse/%u", job->folder, number);
    adcgs_colmap_models models = {.n = 0};
    adcgs_status status = folder ? adcgs_colmap_find(&models, folder, 1, job->error) : no_memory(job);
    free(folder);
    *place = models.place;
    if (status == ADCGS_OK && place->folder)
        status = adcgs_colmap_load(model, place, ADCGS_COLMAP_CAMERAS, job->error);
    if (status == ADCGS_OK && place->folder)
        status = adcgs_colmap_load(model, place, ADCGS_COLMAP_IMAGES, job->error);
    return status;
}

/** Moves the model with most images to out->model, and its location to *place. */
static adcgs_status find_largest(adcgs_poses *out, adcgs_colmap_place *place, const adcgs_import_job *job)
{
    adcgs_status status = ADCGS_OK;
    for (uint32_t number = 0; status == ADCGS_OK; number++) {
        adcgs_colmap model = {0};
        adcgs_colmap_place here = {0};
        status = read_model(&model, &here, job, number);
        const int ends = status != ADCGS_OK || !here.folder;
        if (!ends && model.n_images > out->model.n_images) {
            const adcgs_colmap smaller = out->model;
            const adcgs_colmap_place there = *place;
            out->model = model;
            *place = here;
            model = smaller;
            here = there;
        }
        adcgs_colmap_clear(&model);
        adcgs_colmap_leave(&here);
        if (ends)
            break;
        job->report->models = number + 1;
    }
    return status;
}

/* ---- Views with known poses ---- */

static int by_name(const void *name, const void *image)
{
    return strcmp(name, ((const adcgs_colmap_image *)image)->name);
}

/** COLMAP's image of a source image; NULL if it has no pose. */
static const adcgs_colmap_image *find_image(const adcgs_poses *poses, const adcgs_source_images *sources,
                                            const adcgs_source_image *source)
{
    char name[2 * ADCGS_SOURCE_IMAGE_NAME + 16];
    snprintf(name, sizeof name, "%s/%s.%s", sources->cameras[source->camera].folder, source->stem, source->end);
    return poses->model.n_images ? bsearch(name, poses->model.images, poses->model.n_images, sizeof *poses->model.images, by_name)
                                 : NULL;
}

static adcgs_status add_posed(adcgs_poses *poses, const adcgs_import_job *job, uint32_t source, const adcgs_colmap_image *image)
{
    const adcgs_colmap_camera *camera = adcgs_colmap_find_camera(&poses->model, image->camera_id);
    if (!camera)
        return adcgs_fail(job->error, ADCGS_ERR_DATA, "%s/sparse: %.100s: there is no camera %u", job->folder, image->name,
                          image->camera_id);
    adcgs_posed *p = &poses->posed[poses->n++];
    *p = (adcgs_posed){.source = source, .lens = &camera->lens};
    memcpy(p->cam_to_world, image->cam_to_world, sizeof p->cam_to_world);
    return ADCGS_OK;
}

static adcgs_status list_moving(adcgs_poses *poses, const adcgs_import_job *job)
{
    for (uint32_t i = 0; i < job->sources.n; i++) {
        const adcgs_colmap_image *image = find_image(poses, &job->sources, &job->sources.list[i]);
        if (image)
            ADCGS_TRY(add_posed(poses, job, i, image));
    }
    job->report->posed = poses->n;
    return ADCGS_OK;
}

/** Mean of poses that differ only by errors: of quaternions, whose sign is arbitrary, and of positions. */
typedef struct mean_pose {
    double q[4], position[3];
    int n;
} mean_pose;

static void add_pose(mean_pose *mean, const double pose[12])
{
    double q[4], with = 0.0;
    adcgs_rotation_from_pose(pose, q);
    for (int i = 0; i < 4; i++)
        with += q[i] * mean->q[i];
    for (int i = 0; i < 4; i++)
        mean->q[i] += with < 0.0 ? -q[i] : q[i];
    for (int i = 0; i < 3; i++)
        mean->position[i] += pose[4 * i + 3];
    mean->n++;
}

static void take_mean(const mean_pose *mean, double pose[12])
{
    double q[4], length = 0.0;
    for (int i = 0; i < 4; i++)
        length += mean->q[i] * mean->q[i];
    for (int i = 0; i < 4; i++)
        q[i] = mean->q[i] / sqrt(length);
    adcgs_rotation_to_pose(q, pose);
    for (int i = 0; i < 3; i++)
        pose[4 * i + 3] = mean->position[i] / mean->n;
}

/** Lists a fixed camera, with one pose for all its images. */
static adcgs_status list_standing(adcgs_poses *poses, const adcgs_import_job *job, uint32_t camera)
{
    const adcgs_source_images *sources = &job->sources;
    mean_pose mean = {.n = 0};
    for (uint32_t i = 0; i < sources->n; i++) {
        const adcgs_colmap_image *image =
            sources->list[i].camera == camera ? find_image(poses, sources, &sources->list[i]) : NULL;
        if (!image)
            continue;
        if (!mean.n)
            ADCGS_TRY(add_posed(poses, job, i, image));
        add_pose(&mean, image->cam_to_world);
    }
    job->report->posed += (uint32_t)mean.n;
    if (mean.n)
        take_mean(&mean, poses->posed[poses->n - 1].cam_to_world);
    return ADCGS_OK;
}

static double square_distance(const double a[12], const double b[12])
{
    const double x = a[3] - b[3], y = a[7] - b[7], z = a[11] - b[11];
    return x * x + y * y + z * z;
}

/** Root mean square distance of the images' own poses from their cameras' poses. */
static double find_spread(const adcgs_poses *poses, const adcgs_import_job *job)
{
    const adcgs_source_images *sources = &job->sources;
    double squares = 0.0;
    for (uint32_t p = 0; p < poses->n; p++)
        for (uint32_t i = 0; i < sources->n; i++) {
            const int is_own = sources->list[i].camera == sources->list[poses->posed[p].source].camera;
            const adcgs_colmap_image *image = is_own ? find_image(poses, sources, &sources->list[i]) : NULL;
            if (image)
                squares += square_distance(image->cam_to_world, poses->posed[p].cam_to_world);
        }
    return sqrt(squares / job->report->posed);
}

/** Root mean square distance of the cameras from their centre. */
static double find_extent(const adcgs_poses *poses)
{
    double middle[12] = {0.0}, squares = 0.0;
    for (uint32_t i = 0; i < poses->n; i++)
        for (int a = 0; a < 3; a++)
            middle[4 * a + 3] += poses->posed[i].cam_to_world[4 * a + 3] / poses->n;
    for (uint32_t i = 0; i < poses->n; i++)
        squares += square_distance(poses->posed[i].cam_to_world, middle);
    return sqrt(squares / poses->n);
}

static adcgs_status list_rig(adcgs_poses *poses, const adcgs_import_job *job)
{
    for (uint32_t c = 0; c < job->sources.n_cameras; c++)
        ADCGS_TRY(list_standing(poses, job, c));
    job->report->cameras = job->sources.n_cameras;
    job->report->found = poses->n;
    const double extent = poses->n ? find_extent(poses) : 0.0;
    job->report->spread = extent > 0.0 ? find_spread(poses, job) / extent : 0.0;
    return ADCGS_OK;
}

static adcgs_status list_posed(adcgs_poses *poses, const adcgs_import_job *job)
{
    const int stands = job->sources.kind == ADCGS_FOOTAGE_RIG;
    const uint32_t least = stands ? STANDING_LEAST : POSED_LEAST;
    if (!(poses->posed = calloc((size_t)job->sources.n + 1, sizeof *poses->posed)))
        return no_memory(job);
    ADCGS_TRY(stands ? list_rig(poses, job) : list_moving(poses, job));
    if (poses->n < least)
        return adcgs_fail(job->error, ADCGS_ERR_DATA,
                          "COLMAP found where %u of %u %s were, expected at least %u; check that "
                          "they show the same objects from different positions. COLMAP's output is in %s",
                          poses->n, stands ? job->sources.n_cameras : job->sources.n, stands ? "cameras" : "images", least,
                          job->log);
    const uint32_t every = (uint32_t)job->options->test_every;
    for (uint32_t i = 0; every && i < poses->n; i++)
        poses->posed[i].is_test = i % every == every / 2; /* usually neither the first nor the last: between others */
    return ADCGS_OK;
}

/* ---- Points and world axes ---- */

static int by_id(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/** Adds the images of a training view to the list of training images. */
static void add_training(adcgs_poses *poses, const adcgs_import_job *job, const adcgs_posed *posed)
{
    const adcgs_source_images *sources = &job->sources;
    const int stands = sources->kind == ADCGS_FOOTAGE_RIG;
    for (uint32_t i = 0; i < sources->n; i++) {
        const int is_own = stands ? sources->list[i].camera == sources->list[posed->source].camera : i == posed->source;
        const adcgs_colmap_image *image = is_own ? find_image(poses, sources, &sources->list[i]) : NULL;
        if (image)
            poses->model.training[poses->model.n_training++] = image->id;
    }
}

/** Reads the points, and measures the angles between the images that see them. */
static adcgs_status measure_points(adcgs_colmap *model, const adcgs_colmap_place *place, const adcgs_import_job *job)
{
    adcgs_colmap_angles angles;
    adcgs_colmap_centre *centre = malloc((model->n_images + 1) * sizeof *centre);
    if (!centre)
        return no_memory(job);
    for (size_t i = 0; i < model->n_images; i++) {
        centre[i].id = model->images[i].id;
        for (int a = 0; a < 3; a++)
            centre[i].at[a] = model->images[i].cam_to_world[4 * a + 3];
    }
    adcgs_colmap_angles_init(&angles, centre, model->n_images);
    model->angles = &angles;
    const adcgs_status status = adcgs_colmap_load(model, place, ADCGS_COLMAP_POINTS, job->error);
    model->angles = NULL;
    job->report->angle = adcgs_colmap_angles_median(&angles);
    adcgs_colmap_angles_clear(&angles);
    return status;
}

/** Reads the points that training views see. */
static adcgs_status read_points(adcgs_poses *poses, const adcgs_import_job *job, const adcgs_colmap_place *place)
{
    adcgs_colmap *model = &poses->model;
    if (!(model->training = malloc((model->n_images + 1) * sizeof *model->training)))
        return no_memory(job);
    for (uint32_t i = 0; i < poses->n; i++)
        if (!poses->posed[i].is_test)
            add_training(poses, job, &poses->posed[i]);
    qsort(model->training, model->n_training, sizeof *model->training, by_id);
    ADCGS_TRY(measure_points(model, place, job));
    job->report->points = model->points.n;
    job->report->error = model->tracked ? model->deviation / (double)model->tracked : 0.0;
    job->report->track = model->tracked ? (double)model->seen / (double)model->tracked : 0.0;
    return ADCGS_OK;
}

/** Rotates the columns of a pose: the camera's axes, and its position. */
static void turn_pose(const double axis[3], double angle, double pose[12])
{
    for (int column = 0; column < 4; column++) {
        double v[3] = {pose[column], pose[4 + column], pose[8 + column]};
        adcgs_rotate_about(axis, angle, v);
        for (int a = 0; a < 3; a++)
            pose[4 * a + column] = v[a];
    }
}

/** Rotates the world, whose axes are arbitrary in COLMAP, so that the cameras' mean up direction becomes z. */
static void set_upright(adcgs_poses *poses)
{
    double up[3] = {0.0, 0.0, 0.0}, axis[3];
    for (uint32_t i = 0; i < poses->n; i++)
        for (int a = 0; a < 3; a++)
            up[a] -= poses->posed[i].cam_to_world[4 * a + 1];
    const double across = hypot(up[0], up[1]), angle = atan2(across, up[2]);
    axis[0] = across > 0.0 ? up[1] / across : 1.0; /* up x z */
    axis[1] = across > 0.0 ? -up[0] / across : 0.0;
    axis[2] = 0.0;
    for (uint32_t i = 0; i < poses->n; i++)
        turn_pose(axis, angle, poses->posed[i].cam_to_world);
    for (uint32_t i = 0; i < poses->model.points.n; i++)
        adcgs_rotate_about(axis, angle, poses->model.points.position[i]);
}

adcgs_status adcgs_poses_read(adcgs_poses *out, adcgs_import_job *job)
{
    adcgs_colmap_place place = {0};
    *out = (adcgs_poses){0};
    adcgs_status status = find_largest(out, &place, job);
    if (status == ADCGS_OK && !place.folder)
        status = adcgs_fail(job->error, ADCGS_ERR_DATA,
                            "COLMAP found no cameras; check that images show the same objects "
                            "from different positions. COLMAP's output is in %s",
                            job->log);
    if (status == ADCGS_OK)
        status = list_posed(out, job);
    if (status == ADCGS_OK)
        status = read_points(out, job, &place);
    if (status == ADCGS_OK)
        set_upright(out);
    adcgs_colmap_leave(&place);
    if (status != ADCGS_OK)
        adcgs_poses_clear(out);
    return status;
}
