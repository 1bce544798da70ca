/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settings of a recipe that add to lists: cameras to compare at, cameras of the stream, and its metadata. */
#include "recipe_plan.h"

#include <math.h>
#include <stdio.h>

#define CAMERA_WORDS 20

/* NAME WIDTH HEIGHT FX FY CX CY NEAR M0 .. M11 */
static adcgs_status parse_camera(const adcgs_command *c, adcgs_camera *out, adcgs_error *error)
{
    int64_t width, height;
    double real[17];
    ADCGS_TRY(adcgs_word_int(c->word[2], 1, 16384, &width, error));
    ADCGS_TRY(adcgs_word_int(c->word[3], 1, 16384, &height, error));
    for (int i = 0; i < 17; i++)
        ADCGS_TRY(adcgs_word_real(c->word[4 + i], &real[i], error));
    *out = (adcgs_camera){.width = (int32_t)width,
                          .height = (int32_t)height,
                          .fx = real[0],
                          .fy = real[1],
                          .cx = real[2],
                          .cy = real[3],
                          .near_plane = real[4]};
    memcpy(out->cam_to_world, real + 5, sizeof out->cam_to_world);
    snprintf(out->name, sizeof out->name, "%s", c->word[1]);
    return ADCGS_OK;
}

adcgs_status adcgs_plan_add_camera(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, CAMERA_WORDS, CAMERA_WORDS, error));
    if (plan->n_cameras == ADCGS_PLAN_CAMERAS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "more than %d cameras", ADCGS_PLAN_CAMERAS);
    return parse_camera(c, &plan->cameras[plan->n_cameras++], error);
}

/* After the camera: [time=T [next]]. */
static adcgs_status parse_time(const adcgs_command *c, adcgs_stored_camera *out, const adcgs_stored_camera *before,
                               adcgs_error *error)
{
    const char *const time = c->n > CAMERA_WORDS + 1 ? adcgs_word_value(c->word[CAMERA_WORDS + 1], "time") : NULL;
    out->time = (double)NAN;
    out->path = -1;
    if (c->n > CAMERA_WORDS + 1 && !time)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected time=T", c->word[CAMERA_WORDS + 1]);
    if (time)
        ADCGS_TRY(adcgs_word_real(time, &out->time, error));
    if (c->n <= CAMERA_WORDS + 2)
        return ADCGS_OK;
    if (strcmp(c->word[CAMERA_WORDS + 2], "next") != 0 || !before)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected next, after another camera", c->word[CAMERA_WORDS + 2]);
    out->path = before->path;
    return ADCGS_OK;
}

adcgs_status adcgs_plan_add_stored(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_stream *const s = &plan->stream;
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, CAMERA_WORDS, CAMERA_WORDS + 2, error));
    if (!s->cameras)
        s->cameras = adcgs_alloc(NULL, ADCGS_PLAN_CAMERAS, sizeof *s->cameras, error);
    if (!s->cameras || s->n_cameras == ADCGS_PLAN_CAMERAS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "no memory for a stored camera, or too many of them");
    adcgs_stored_camera *const to = &s->cameras[s->n_cameras], *const before = s->n_cameras ? to - 1 : NULL;
    ADCGS_TRY(parse_camera(c, &to->camera, error));
    if (before && c->n == CAMERA_WORDS + 3 && before->path < 0)
        before->path = (int)s->n_cameras;
    s->n_cameras++;
    return parse_time(c, to, before, error);
}

static char *copy_text(const char *text, adcgs_error *error)
{
    char *const out = adcgs_alloc(NULL, strlen(text) + 1, 1, error);
    if (out)
        memcpy(out, text, strlen(text));
    return out;
}

/* KEY VALUE, or KEY times=N VALUE: the entry's text is N copies of VALUE. */
adcgs_status adcgs_plan_add_meta(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_stream *const s = &plan->stream;
    int64_t times = 1;
    (void)user;
    ADCGS_TRY(adcgs_command_words(c, 2, 3, error));
    if (c->n == 4 && !adcgs_word_value(c->word[2], "times"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected times=N", c->word[2]);
    if (c->n == 4)
        ADCGS_TRY(adcgs_word_int(adcgs_word_value(c->word[2], "times"), 0, 65535, &times, error));
    const char *const value = c->word[c->n - 1];
    if (!s->meta)
        s->meta = adcgs_alloc(NULL, ADCGS_PLAN_CAMERAS, sizeof *s->meta, error);
    if (!s->meta || s->n_meta == ADCGS_PLAN_CAMERAS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "no memory for an entry of metadata, or too many of them");
    s->meta[s->n_meta].key = copy_text(c->word[1], error);
    char *const text = s->meta[s->n_meta].value = adcgs_alloc(NULL, strlen(value) * (size_t)times + 1, 1, error);
    if (!s->meta[s->n_meta++].key || !text)
        return ADCGS_ERR_MEMORY;
    for (int64_t i = 0; i < times; i++)
        memcpy(text + (size_t)i * strlen(value), value, strlen(value));
    return ADCGS_OK;
}
