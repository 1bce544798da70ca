/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The report of adcgs-enc on a written file. */
#include "session/enc_report.h"

#include "metric/evaluate.h"
#include "session/enc_diagnose.h"
#include "system/interrupt.h"
#include "system/json.h"
#include "system/text.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>

/** Tolerances of the targets: size below the requested one, as a share; PSNR, dB; chosen by hand, not measured. */
#define SIZE_WITHIN 0.03
#define PSNR_WITHIN 0.1

/** The target and the result; kind NULL: no target. */
typedef struct outcome {
    const char *kind;
    double value, reached;
    int met;
} outcome;

/** The printed result. */
typedef struct result {
    adcgs_info info;
    adcgs_evaluation quality; /**< of the views of split */
    adcgs_split split;
    outcome target;
    double lambda; /**< of the last segment, from the file */
} result;

static void print_text(const adcgs_enc_report *r, const result *x)
{
    const adcgs_bytes *b = &x->info.bytes;
    const uint64_t features = b->layer[0] + b->layer[1] + b->layer[2] + b->layer[3] + b->layer[4];
    adcgs_text_show(stderr, r->file);
    fprintf(stderr, ": %llu bytes: networks %llu, geometry %llu, features %llu, cameras %llu, rest %llu\n",
            (unsigned long long)b->total, (unsigned long long)b->networks, (unsigned long long)b->geometry,
            (unsigned long long)features, (unsigned long long)b->cameras, (unsigned long long)(b->header + b->metadata));
    if (x->info.segments > 1)
        fprintf(stderr, "%d segments; ", x->info.segments);
    fprintf(stderr, "%u anchors (%u static), %u primitives; lambda %.3g; trained in %.0f s (CPU %.0f s)\n", x->info.anchors,
            x->info.static_anchors, x->info.gaussians, x->lambda, r->spent.clock, r->spent.cpu);
    fprintf(stderr, "decoded from the file, %u %s view%s: %.2f dB PSNR, %.4f SSIM\n", x->quality.n, adcgs_split_name(x->split),
            adcgs_s(x->quality.n), x->quality.psnr, x->quality.ssim);
}

/** Rounds to six digits, so that the binary32 number nearest to 0.01 is printed as 0.01. */
static double shown(double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.6g", x);
    return strtod(text, NULL);
}

static void print_components(adcgs_json *j, const adcgs_bytes *b)
{
    adcgs_json_open(j, "components", '{');
    adcgs_json_int(j, "header", (int64_t)b->header);
    adcgs_json_int(j, "networks", (int64_t)b->networks);
    adcgs_json_int(j, "geometry", (int64_t)b->geometry);
    for (int i = 0; i < 5; i++) {
        char name[24];
        snprintf(name, sizeof name, "layer%d", i);
        adcgs_json_int(j, name, (int64_t)b->layer[i]);
    }
    adcgs_json_int(j, "cameras", (int64_t)b->cameras);
    adcgs_json_int(j, "metadata", (int64_t)b->metadata);
    adcgs_json_close(j);
}

static adcgs_status print_json(const adcgs_enc_report *r, const result *x, adcgs_error *error)
{
    adcgs_json j;
    adcgs_json_init(&j);
    adcgs_json_open(&j, NULL, '{');
    adcgs_json_string(&j, "file", r->file);
    adcgs_json_int(&j, "bytes", (int64_t)x->info.bytes.total);
    print_components(&j, &x->info.bytes);
    adcgs_json_int(&j, "segments", x->info.segments);
    adcgs_json_int(&j, "anchors", x->info.anchors);
    adcgs_json_int(&j, "static_anchors", x->info.static_anchors);
    adcgs_json_int(&j, "primitives", x->info.gaussians);
    adcgs_json_int(&j, "weights", x->info.weights);
    if (r->uncompressed)
        adcgs_json_int(&j, "uncompressed_bytes", (int64_t)r->uncompressed);
    adcgs_json_real(&j, "lambda", shown(x->lambda));
    if (x->target.kind) {
        adcgs_json_open(&j, "target", '{');
        adcgs_json_string(&j, "kind", x->target.kind);
        adcgs_json_real(&j, "value", x->target.value);
        adcgs_json_real(&j, "reached", x->target.reached);
        adcgs_json_bool(&j, "met", x->target.met);
        adcgs_json_close(&j);
    }
    adcgs_json_int(&j, "iterations", r->last.iteration);
    adcgs_json_real(&j, "training_seconds", r->spent.clock);
    adcgs_json_real(&j, "cpu_seconds", r->spent.cpu);
    adcgs_json_real(&j, "training_psnr", r->last.psnr);
    adcgs_json_real(&j, "loss", r->last.loss);
    if (x->lambda >= 0)
        adcgs_json_real(&j, "objective", r->last.loss + x->lambda * (double)x->info.bytes.total / (1 << 20));
    adcgs_json_string(&j, "split", adcgs_split_name(x->split));
    adcgs_json_real(&j, "psnr", x->quality.psnr);
    adcgs_json_real(&j, "ssim", x->quality.ssim);
    adcgs_json_close(&j);
    return adcgs_json_write(&j, stdout, "standard output", error);
}

/** Progress of the measurement. */
typedef struct counter {
    adcgs_progress progress;
    uint32_t done, n;
    int interrupts;
} counter;

static adcgs_status count_view(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    counter *c = user;
    (void)score;
    if (adcgs_interrupts() > c->interrupts)
        return adcgs_fail(error, ADCGS_ERR_IO, "interrupted after %u of %u view%s were measured", c->done, c->n, adcgs_s(c->n));
    adcgs_progress_show(&c->progress, "measured  %6u/%u", ++c->done, c->n);
    return ADCGS_OK;
}

/** Measures PSNR and SSIM of a split's views. */
static adcgs_status evaluate(adcgs_evaluation *out, const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_enc_report *r,
                             adcgs_split split, adcgs_error *error)
{
    const adcgs_scene *const scene = r->scene;
    counter c = {.n = scene->n_views[split], .interrupts = r->interrupts};
    adcgs_progress_init(&c.progress, cli);
    const adcgs_status status = adcgs_evaluate(out, decoder, scene, split, 0, count_view, &c, error);
    adcgs_progress_clear(&c.progress);
    return status;
}

/** Compares the result with the target. The PSNR of training views is measured from the file like any other. */
static adcgs_status judge(const adcgs_cli *cli, outcome *o, const adcgs_enc_report *r, const adcgs_info *info,
                          adcgs_decoder *decoder, adcgs_error *error)
{
    const adcgs_train_config *c = r->config;
    adcgs_evaluation e;
    *o = (outcome){.value = c->target_value, .met = 1};
    if (c->target == ADCGS_TARGET_SIZE) {
        o->kind = "size";
        o->reached = (double)info->bytes.total;
        o->met = o->reached <= o->value && o->reached > (1 - SIZE_WITHIN) * o->value;
    } else if (c->target == ADCGS_TARGET_PSNR) {
        ADCGS_TRY(evaluate(&e, cli, decoder, r, ADCGS_SPLIT_TRAIN, error));
        o->kind = "psnr";
        o->reached = e.psnr;
        o->met = fabs(o->reached - o->value) <= PSNR_WITHIN;
    }
    return ADCGS_OK;
}

static void report_missed(const adcgs_cli *cli, const adcgs_enc_report *r, const outcome *o)
{
    if (!strcmp(o->kind, "size"))
        adcgs_cli_error(cli, ADCGS_OK,
                        "%s: %.0f bytes, smaller than the requested %.0f: more anchors, or a longer run, would use them", r->file,
                        o->reached, o->value);
    else
        adcgs_cli_error(cli, ADCGS_OK, "%s: the training views have %.2f dB instead of the requested %.2f: %s", r->file,
                        o->reached, o->value, o->reached < o->value ? "the maximum of this run" : "the minimum of this run");
}

static adcgs_status measure(const adcgs_cli *cli, result *x, const adcgs_enc_report *r, adcgs_decoder *decoder,
                            adcgs_error *error)
{
    const adcgs_scene *scene = r->scene;
    x->split = scene->n_views[ADCGS_SPLIT_TEST]  ? ADCGS_SPLIT_TEST
               : scene->n_views[ADCGS_SPLIT_VAL] ? ADCGS_SPLIT_VAL
                                                 : ADCGS_SPLIT_TRAIN;
    const char *const lambda = adcgs_get_metadata(decoder, "lambda");
    x->lambda = lambda ? strtod(lambda, NULL) : 0;
    ADCGS_TRY(adcgs_get_info(decoder, &x->info, sizeof x->info, error));
    ADCGS_TRY(evaluate(&x->quality, cli, decoder, r, x->split, error));
    return judge(cli, &x->target, r, &x->info, decoder, error);
}

/** The file is complete, even if it could not be measured. */
static void report_written(const adcgs_enc_report *r, adcgs_error *error)
{
    const adcgs_error why = *error;
    adcgs_fail(error, why.status, "%s; but %s is written", why.text, r->file);
}

adcgs_status adcgs_enc_report_print(const adcgs_cli *cli, const adcgs_enc_report *r, int *met, adcgs_error *error)
{
    adcgs_config config;
    adcgs_decoder *decoder;
    result x;
    adcgs_config_init(&config, sizeof config);
    config.threads = r->threads;
    config.cpu = r->cpu;
    ADCGS_TRY(adcgs_open_file(&decoder, r->file, &config, error));
    adcgs_status status = measure(cli, &x, r, decoder, error);
    *met = status != ADCGS_OK || x.target.met;
    if (status != ADCGS_OK)
        report_written(r, error);
    if (status != ADCGS_OK && adcgs_interrupts() > r->interrupts && !r->json) {
        adcgs_close(&decoder);
        adcgs_cli_error(cli, ADCGS_OK, "%s", error->text);
        return ADCGS_OK;
    }
    if (status == ADCGS_OK && r->json)
        status = print_json(r, &x, error);
    else if (status == ADCGS_OK && !*cli->quiet)
        print_text(r, &x);
    /* Test views keep their original light, so they do not match training views with evened light. */
    const int tells = x.split != ADCGS_SPLIT_TRAIN && !r->config->exposure_step_compensation;
    if (status == ADCGS_OK)
        adcgs_enc_diagnose(cli, decoder, r->scene, tells ? x.quality.psnr : (double)NAN, r->file, r->interrupts);
    if (status == ADCGS_OK && !x.target.met)
        report_missed(cli, r, &x.target);
    adcgs_close(&decoder);
    return status;
}
