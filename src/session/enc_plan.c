/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Makes plans and trains segments of plans. */
#include "config.h"

#include "session/enc_plan.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "session/enc_footage.h"
#include "session/enc_parts.h"
#include "session/enc_segments.h"
#include "session/plan_parts.h"
#include "system/claim.h"
#include "system/json.h"
#include "train/anchor_plan.h"
#include "train/resolve.h"

#include <math.h>
#include <stdlib.h>

/* ---- Options ---- */

static size_t size_of(adcgs_option_kind kind)
{
    return kind == ADCGS_OPTION_REAL || kind == ADCGS_OPTION_SECONDS  ? sizeof(double)
           : kind == ADCGS_OPTION_SIZE                                ? sizeof(uint64_t)
           : kind == ADCGS_OPTION_STRING || kind == ADCGS_OPTION_FILE ? sizeof(char *)
                                                                      : sizeof(int);
}

/** Returns the first given option that is not among the names, which end with NULL; NULL if there is none. */
static const char *find_other(const adcgs_cli *cli, const adcgs_enc_options *o, const adcgs_enc_options *before,
                              const char *const *names)
{
    for (size_t i = 0; i < cli->n_options; i++) {
        const adcgs_option *const option = &cli->options[i];
        if (option->kind == ADCGS_OPTION_FORMER)
            continue;
        const size_t at = (size_t)((const char *)option->target - (const char *)o);
        const int given =
            option->given ? *option->given : memcmp(option->target, (const char *)before + at, size_of(option->kind)) != 0;
        const char *const *name = names;
        while (*name && strcmp(*name, option->name))
            name++;
        if (given && !*name)
            return option->name;
    }
    return NULL;
}

int adcgs_enc_plan_check(const adcgs_cli *cli, const adcgs_enc_options *o, const adcgs_enc_options *before)
{
    static const char *const making[] = {"plan",   "cut",        "key",    "fade",    "preset",      "lambda",
                                         "psnr",   "iterations", "scale",  "k",       "max-anchors", "dataset",
                                         "frames", "fps",        "points", "without", "fixed",       "no-progression",
                                         "set",    "seed",       "cpu",    "bf16",    "threads",     NULL};
    static const char *const learning[] = {"plan",   "segment", "points", "log", "checkpoint-every",
                                           "memory", "threads", "json",   NULL};
    const char *const other = find_other(cli, o, before, o->has_segment ? learning : making);
    if (other && o->has_segment)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--%s: the plan sets the training of its segments: give --plan and "
                               "--segment without it",
                               other);
    if (other)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--%s is not a setting of plans: leave it out", other);
    if (o->has_segment && (o->segment < 1 || o->segment != floor(o->segment)))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--segment %g: with --plan, the number of a segment is expected",
                               o->segment);
    return -1;
}

/* ---- Making a plan ---- */

static char *copy(const char *text, int *failed)
{
    char *const out = text ? strdup(text) : NULL;
    *failed |= text && !out;
    return out;
}

static void take_outline(const adcgs_scene *scene, char text[2 * ADCGS_CONTENT_BYTES + 1])
{
    uint8_t digest[ADCGS_CONTENT_BYTES];
    adcgs_scene_outline(scene, digest);
    adcgs_md5_hex(digest, text);
}

/** The header that the streams of all parts share. */
static adcgs_status plan_coding(adcgs_plan *p, const adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_stream head;
    const adcgs_status status = adcgs_encode_begin(&head, job->scene, &job->cuts, NULL, 0, error);
    memcpy(p->origin, head.scene_origin, sizeof p->origin);
    p->scale = head.scene_scale;
    p->timebase_num = head.timebase_num;
    p->timebase_den = head.timebase_den;
    adcgs_stream_clear(&head, NULL);
    return status;
}

/** Cuts and follows belong to the job. */
static adcgs_status fill(adcgs_plan *p, adcgs_enc_job *job, const adcgs_scene_options *options, adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    adcgs_train_config *c = &p->config;
    int failed = 0;
    snprintf(p->encoder, sizeof p->encoder, "adcgs-enc %s", PACKAGE_VERSION);
    p->scene = copy(o->scene, &failed);
    p->points = copy(o->points, &failed);
    p->frames = copy(o->frames, &failed);
    if (failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", o->plan);
    p->dataset = o->dataset;
    p->rate = options->rate;
    take_outline(job->scene, p->outline);
    p->has_alpha = job->scene->has_alpha;
    memcpy(p->background, job->scene->background, sizeof p->background);
    p->cpu = job->cpu;
    *c = job->whole; /* the configuration before cutting */
    p->has_details = adcgs_resolve_wants_details(c);
    if (p->has_details)
        ADCGS_TRY(adcgs_plan_details(job->scene, c->scale, &p->details, error));
    p->segments = adcgs_alloc(NULL, job->cuts.n, sizeof *p->segments, error);
    if (!p->segments)
        return adcgs_alloc_status(error);
    p->cuts = job->cuts;
    for (uint32_t i = 0; i < p->cuts.n; i++)
        p->segments[i].follows = job->follows[i];
    return plan_coding(p, job, error);
}

static adcgs_status make(adcgs_plan *p, adcgs_enc_job *job, const adcgs_scene_options *options, adcgs_error *error)
{
    const char *const path = job->o->plan;
    double cost = 0;
    uint32_t keys = 0;
    ADCGS_TRY(fill(p, job, options, error));
    ADCGS_TRY(adcgs_plan_write(p, job->scene, path, error));
    adcgs_plan_clear(p); /* together with the job's cuts */
    job->cuts = (adcgs_cuts){.n = 0};
    ADCGS_TRY(adcgs_plan_read(p, path, error));
    for (uint32_t i = 0; i < p->cuts.n; i++) {
        cost += p->segments[i].cost;
        keys += !p->segments[i].follows;
    }
    adcgs_cli_note(job->cli, "%s: %u segment%s, %u of them key%s; estimated %.0f s of one processor", path, p->cuts.n,
                   p->cuts.n > 1 ? "s" : "", keys, keys > 1 ? "s" : "", cost);
    return ADCGS_OK;
}

adcgs_status adcgs_enc_plan_make(adcgs_enc_job *job, const adcgs_scene_options *options, adcgs_error *error)
{
    adcgs_plan plan = {.dataset = 0};
    ADCGS_TRY(adcgs_scene_open(&job->scene, job->o->scene, options, error));
    adcgs_enc_report_remarks(job->cli, job->scene);
    adcgs_enc_reduce_large(job, job->scene, NULL);
    ADCGS_TRY(adcgs_enc_cut(job, job->o->cut, error));
    const adcgs_status status = make(&plan, job, options, error);
    if (plan.cuts.at == job->cuts.at)
        job->cuts = (adcgs_cuts){.n = 0};
    adcgs_plan_clear(&plan);
    return status;
}

/* ---- Training a segment ---- */

/** Opens the scene of the plan, without reading images of other segments. */
static adcgs_status open_scene(adcgs_enc_job *job, const adcgs_plan *p, adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    adcgs_scene_options options = {.points_path = o->points ? o->points : p->points,
                                   .dataset = p->dataset,
                                   .rate = p->rate,
                                   .is_outline = 1};
    char outline[sizeof p->outline];
    if (p->frames)
        ADCGS_TRY(adcgs_frames_parse(&options.frames, p->frames, error));
    ADCGS_TRY(adcgs_scene_open(&job->scene, o->scene, &options, error));
    take_outline(job->scene, outline);
    if (strcmp(outline, p->outline))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: not the scene of %s, which was %.80s: cameras, times or points differ",
                          o->scene, o->plan, p->scene ? p->scene : "?");
    job->scene->has_alpha = p->has_alpha;
    memcpy(job->scene->background, p->background, sizeof p->background);
    memcpy(job->scene->origin, p->origin, sizeof p->origin);
    job->scene->scale = p->scale;
    return ADCGS_OK;
}

/** Takes the training settings of the plan. The job borrows its cuts. */
static adcgs_status take_settings(adcgs_enc_context *w, adcgs_enc_job *job, const adcgs_plan *p, adcgs_error *error)
{
    ADCGS_TRY(adcgs_plan_check_version(p, job->o->plan, error));
    if (adcgs_cpu_resolve(p->cpu, &job->cpu, error) != ADCGS_OK)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "%s: for kernels of level %s, which this machine lacks: a plan made with "
                          "--cpu %s fits all machines that have "
                          "those",
                          job->o->plan, adcgs_cpu_name(p->cpu), adcgs_cpu_name(adcgs_cpu_best()));
    job->plan = p;
    job->requested = &p->config;
    job->config = *job->requested;
    if (p->config.bf16)
        ADCGS_TRY(adcgs_bf16_check(job->cpu, error));
    w->changes.size = 0;
    ADCGS_TRY(adcgs_train_changes(&job->config, &w->changes, error));
    job->cuts = p->cuts;
    adcgs_enc_cut_config(job);
    job->follows = adcgs_alloc(NULL, p->cuts.n, sizeof *job->follows, error);
    if (!job->follows)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < p->cuts.n; i++)
        job->follows[i] = p->segments[i].follows;
    if (job->o->segment > p->cuts.n)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--segment %g: %s has %u", job->o->segment, job->o->plan, p->cuts.n);
    w->segments = p->cuts.n;
    w->segment = (uint32_t)job->o->segment - 1;
    return ADCGS_OK;
}

static adcgs_status report(const adcgs_enc_job *job, const adcgs_enc_context *w, adcgs_time spent, const char *name,
                           adcgs_error *error)
{
    adcgs_json j;
    const double begin = job->cuts.at[w->segment], end = job->cuts.at[w->segment + 1];
    if (!job->o->json) {
        adcgs_cli_note(job->cli, "%s: segment %u of %u, %.3f to %.3f s: %u anchors; trained in %.0f s (CPU %.0f s)", name,
                       w->segment + 1, w->segments, begin, end, w->last.anchors, spent.clock, spent.cpu);
        return ADCGS_OK;
    }
    adcgs_json_init(&j);
    adcgs_json_open(&j, NULL, '{');
    adcgs_json_string(&j, "file", name);
    adcgs_json_int(&j, "segment", w->segment + 1);
    adcgs_json_int(&j, "segments", w->segments);
    adcgs_json_real(&j, "begin", begin);
    adcgs_json_real(&j, "end", end);
    adcgs_json_int(&j, "iterations", w->last.iteration);
    adcgs_json_real(&j, "training_seconds", spent.clock);
    adcgs_json_real(&j, "cpu_seconds", spent.cpu);
    adcgs_json_real(&j, "training_psnr", w->last.psnr);
    adcgs_json_close(&j);
    return adcgs_json_write(&j, stdout, "standard output", error);
}

/** Trains the segment, unless it is present already. */
static adcgs_status learn(adcgs_enc_context *w, adcgs_enc_job *job, const char *name, adcgs_error *error)
{
    adcgs_stream there;
    adcgs_time spent = {0, 0};
    int found;
    adcgs_status status = adcgs_plan_part_load(&there, job->plan, w->base, w->segment, job->cpu, job->pool, &found, error);
    adcgs_stream_clear(&there, NULL);
    if (status == ADCGS_OK && found) {
        adcgs_cli_note(job->cli, "%s: present already", name);
        return ADCGS_OK;
    }
    if (status == ADCGS_OK)
        status = open_scene(job, job->plan, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_compensate_light(job, &w->progress, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_segment_train(w, job, &spent, error);
    return status == ADCGS_OK ? report(job, w, spent, name, error) : status;
}

static adcgs_status learn_claimed(adcgs_enc_context *w, adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_claim *claim = NULL;
    char *name, *claimed = NULL, what[64];
    ADCGS_TRY(adcgs_enc_part_name(&name, w->base, w->segment, 1, error));
    w->target = name;
    snprintf(what, sizeof what, "segment %u", w->segment + 1);
    adcgs_status status = adcgs_enc_claim_name(&claimed, w->state, error);
    if (status == ADCGS_OK)
        status = adcgs_claim_take(&claim, claimed, what, error);
    if (status == ADCGS_OK)
        status = learn(w, job, name, error);
    adcgs_claim_drop(&claim);
    w->target = job->o->plan;
    free(claimed);
    free(name);
    return status;
}

adcgs_status adcgs_enc_plan_train(adcgs_enc_context *w, adcgs_enc_job *job, adcgs_error *error)
{
    adcgs_plan plan = {.dataset = 0};
    adcgs_status status = adcgs_plan_read(&plan, job->o->plan, error);
    if (status == ADCGS_OK)
        status = take_settings(w, job, &plan, error);
    if (status == ADCGS_OK)
        status = adcgs_plan_base(&w->base, job->o->plan, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_part_name(&w->state, w->base, w->segment, 0, error);
    if (status == ADCGS_OK)
        status = learn_claimed(w, job, error);
    job->plan = NULL;
    if (job->cuts.at == plan.cuts.at)
        job->cuts = (adcgs_cuts){.n = 0};
    adcgs_plan_clear(&plan);
    return status;
}
