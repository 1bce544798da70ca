/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training cost of plans, and writing plans. */
#include "config.h"

#include "session/plan.h"

#include "scene/layouts/open.h"
#include "system/atomic.h"
#include "system/json.h"
#include "train/resolve.h"

#include <adcgs/cpu.h>

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/*
 * Seconds of one processor with AVX-512: per iteration and possible anchor, per iteration and rendered pixel, and per pixel read.
 * Calibrated on the seven dynamic scenes in README.md's "Figures": six take 0.9 to 1.4 times this estimate, and one takes 0.4
 * times.
 */
#define PER_ANCHOR 4.5e-6
#define PER_PIXEL 8e-8
#define PER_PIXEL_READ 6e-8

void adcgs_plan_clear(adcgs_plan *p)
{
    free(p->scene);
    free(p->points);
    free(p->frames);
    adcgs_cuts_clear(&p->cuts);
    adcgs_free(NULL, p->segments);
    *p = (adcgs_plan){.dataset = 0};
}

/** The mean share of all image pixels that an iteration renders: images begin smaller. */
static double share_drawn(const adcgs_train_config *c)
{
    const double quarter = fmin((double)c->quarter_size_until, 1), half = fmax(fmin((double)c->half_size_until, 1), quarter);
    return (quarter / 16 + (half - quarter) / 4 + (1 - half)) / ((double)c->scale * c->scale);
}

double adcgs_plan_cost(const adcgs_plan *plan, const adcgs_scene *part)
{
    double pixels = 0;
    adcgs_train_config c = plan->config;
    if (plan->has_details)
        adcgs_resolve_anchors(&c, plan->details);
    const uint32_t n = part->n_views[ADCGS_SPLIT_TRAIN];
    for (uint32_t i = 0; i < n; i++)
        pixels += (double)part->views[ADCGS_SPLIT_TRAIN][i].camera.width * part->views[ADCGS_SPLIT_TRAIN][i].camera.height;
    const double look = n ? PER_ANCHOR * c.max_anchors + PER_PIXEL * share_drawn(&c) * pixels / n : 0;
    return PER_PIXEL_READ * pixels + (double)c.iterations * c.batch * look;
}

/* ---- Writing ---- */

/** Writes null for NULL, so that a plan states the absence. */
static void put_text(adcgs_json *j, const char *key, const char *text)
{
    if (text)
        adcgs_json_string(j, key, text);
    else
        adcgs_json_real(j, key, (double)NAN);
}

static void put_reals(adcgs_json *j, const char *key, const double *x, int n)
{
    adcgs_json_open(j, key, '[');
    for (int i = 0; i < n; i++)
        adcgs_json_real(j, NULL, x[i]);
    adcgs_json_close(j);
}

static void put_scene(adcgs_json *j, const adcgs_plan *p)
{
    const double background[3] = {(double)p->background[0], (double)p->background[1], (double)p->background[2]};
    char rate[48];
    snprintf(rate, sizeof rate, "%lld/%lld", (long long)p->rate.num, (long long)p->rate.den);
    put_text(j, "scene", p->scene);
    put_text(j, "points", p->points);
    put_text(j, "frames", p->frames);
    adcgs_json_string(j, "dataset", adcgs_dataset_names[p->dataset]);
    put_text(j, "fps", p->rate.den ? rate : NULL);
    adcgs_json_string(j, "outline", p->outline);
    adcgs_json_bool(j, "alpha", p->has_alpha);
    put_reals(j, "background", background, 3);
}

static void put_settings(adcgs_json *j, const adcgs_plan *p)
{
    const adcgs_train_config *c = &p->config;
    adcgs_json_string(j, "cpu", adcgs_cpu_name(p->cpu));
    adcgs_json_string(j, "preset", c->preset);
    adcgs_json_open(j, "settings", '{');
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        adcgs_json_real(j, s->name, adcgs_setting_get(s, c));
    adcgs_json_close(j);
    adcgs_json_open(j, "chosen", '[');
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        if (adcgs_setting_is_given(c, s->name))
            adcgs_json_string(j, NULL, s->name);
    adcgs_json_close(j);
    adcgs_json_real(j, "psnr", c->target == ADCGS_TARGET_PSNR ? c->target_value : (double)NAN);
    adcgs_json_real(j, "details", p->has_details ? p->details : (double)NAN);
}

/** A path relative to the scene's folder, if it lies there. */
static const char *beside(const adcgs_scene *scene, const char *path)
{
    const size_t n = strlen(scene->directory);
    return strncmp(path, scene->directory, n) || path[n] != '/' ? path : path + n + 1;
}

/** Lists each file once: views of a video follow each other. */
static void put_files(adcgs_json *j, const adcgs_scene *scene, const adcgs_scene *part)
{
    const char *last = NULL;
    adcgs_json_open(j, "files", '[');
    for (uint32_t i = 0; i < part->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const adcgs_scene_view *const v = &part->views[ADCGS_SPLIT_TRAIN][i];
        if (!last || strcmp(last, v->path))
            adcgs_json_string(j, NULL, beside(scene, v->path));
        if (v->mask)
            adcgs_json_string(j, NULL, beside(scene, v->mask));
        last = v->path;
    }
    adcgs_json_close(j);
}

static adcgs_status put_segment(adcgs_json *j, const adcgs_plan *p, const adcgs_scene *scene, uint32_t i, adcgs_error *error)
{
    adcgs_scene part;
    ADCGS_TRY(adcgs_scene_part(&part, scene, &p->cuts, i, error));
    adcgs_json_open(j, NULL, '{');
    adcgs_json_real(j, "begin", p->cuts.at[i]);
    adcgs_json_real(j, "end", p->cuts.at[i + 1]);
    adcgs_json_real(j, "crossfade", p->cuts.reach[i]);
    adcgs_json_int(j, "follows", p->segments[i].follows ? i : 0);
    adcgs_json_int(j, "views", part.n_views[ADCGS_SPLIT_TRAIN]);
    adcgs_json_real(j, "cost", round(10 * adcgs_plan_cost(p, &part)) / 10);
    put_files(j, scene, &part);
    adcgs_json_close(j);
    adcgs_scene_part_clear(&part);
    return ADCGS_OK;
}

static adcgs_status put_plan(adcgs_json *j, const adcgs_plan *p, const adcgs_scene *scene, adcgs_error *error)
{
    const double base[2] = {p->timebase_num, p->timebase_den};
    adcgs_json_open(j, NULL, '{');
    adcgs_json_int(j, "adcgs_plan", ADCGS_PLAN_FORMAT);
    adcgs_json_string(j, "encoder", p->encoder);
    put_scene(j, p);
    put_settings(j, p);
    put_reals(j, "origin", p->origin, 3);
    adcgs_json_real(j, "scale", p->scale);
    put_reals(j, "time_base", base, 2);
    adcgs_json_int(j, "moments", p->cuts.moments);
    adcgs_json_open(j, "segments", '[');
    for (uint32_t i = 0; i < p->cuts.n; i++)
        ADCGS_TRY(put_segment(j, p, scene, i, error));
    adcgs_json_close(j);
    adcgs_json_close(j);
    return ADCGS_OK;
}

static adcgs_status write_file(adcgs_json *j, const char *path, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    const adcgs_status status = adcgs_json_write(j, file.file, path, error);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&file, error);
    adcgs_atomic_abort(&file);
    return status;
}

/** Writes the plan under another name and reads it back: equal plans have equal digests. */
static adcgs_status compare(adcgs_json *j, const char *path, adcgs_error *error)
{
    adcgs_plan there = {.dataset = 0}, here = {.dataset = 0};
    const size_t n = strlen(path) + 32;
    char *other = malloc(n);
    if (!other)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    snprintf(other, n, "%s.%ld", path, (long)getpid());
    adcgs_status status = adcgs_plan_read(&there, path, error);
    if (status == ADCGS_OK)
        status = write_file(j, other, error);
    if (status == ADCGS_OK)
        status = adcgs_plan_read(&here, other, error);
    unlink(other);
    if (status == ADCGS_OK && strcmp(here.digest, there.digest))
        status = adcgs_fail(error, ADCGS_ERR_IO,
                            "%s: exists and is another plan, which finished parts may belong to: remove it, "
                            "or name another file",
                            path);
    adcgs_plan_clear(&there);
    adcgs_plan_clear(&here);
    free(other);
    return status;
}

adcgs_status adcgs_plan_write(const adcgs_plan *p, const adcgs_scene *scene, const char *path, adcgs_error *error)
{
    adcgs_json json;
    adcgs_json_init(&json);
    json.digits = 17;
    adcgs_status status = put_plan(&json, p, scene, error);
    if (status == ADCGS_OK)
        status = access(path, F_OK) ? write_file(&json, path, error) : compare(&json, path, error);
    adcgs_json_clear(&json);
    return status;
}
