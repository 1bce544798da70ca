/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The report of adcgs-eval on the views. */
#include "config.h"

#include "apps/eval/eval_report.h"

#include "system/text.h"

#include <math.h>
#include <stdlib.h>

#define NAME_WIDTH 24           /* columns of a name in the table; chosen by hand, not measured */
#define ALWAYS 0                /* no flag is needed; definition */
#define CROP ADCGS_EVAL_COLUMNS /* beyond all flags */

/**
 * digits: of the text; -1: not in the text. wanted: flags of which at least one must be set, or ALWAYS or CROP. is_of_camera: a
 * value of all views of a camera together; single views have it only if more is known about them.
 */
typedef struct column {
    const char *key, *label, *unit;
    int digits, wanted, is_of_camera;
} column;

static const column columns[ADCGS_EVAL_COLUMNS] = {
    [ADCGS_EVAL_PSNR] = {"psnr", "", " dB", 2, ALWAYS, 0},
    [ADCGS_EVAL_SSIM] = {"ssim", "", "", 4, ALWAYS, 0},
    [ADCGS_EVAL_FITTED_PSNR] = {"fitted_psnr", "  fitted", " dB", 2, ADCGS_MEASURE_FITTED, 0},
    [ADCGS_EVAL_MS_SSIM] = {"ms_ssim", "  ms-ssim", "", 4, ADCGS_MEASURE_MS_SSIM, 0},
    [ADCGS_EVAL_MS_SSIM_SCALES] = {"ms_ssim_scales", "", "", -1, ADCGS_MEASURE_MS_SSIM, 0},
    [ADCGS_EVAL_DYNAMIC_PSNR] = {"dynamic_psnr", "  dynamic", " dB", 2, ADCGS_MEASURE_DYNAMIC, 0},
    [ADCGS_EVAL_FITTED_DYNAMIC_PSNR] = {"fitted_dynamic_psnr", "  fitted dynamic", " dB", 2, ADCGS_MEASURE_FITTED_DYNAMIC, 0},
    [ADCGS_EVAL_FLICKER] = {"flicker", "  flicker", "", 5, ADCGS_MEASURE_FLICKER, 0},
    [ADCGS_EVAL_DYNAMIC_SHARE] = {"dynamic_share", "  dynamic share", "", 4, ADCGS_MEASURE_MOVING | ADCGS_MEASURE_STATIC, 1},
    [ADCGS_EVAL_STATIC_VARIANCE] = {"static_variance", "  static variance", "", 8, ADCGS_MEASURE_STATIC, 1},
    [ADCGS_EVAL_TRUTH_VARIANCE] = {"truth_static_variance", "  of the truth", "", 8, ADCGS_MEASURE_STATIC, 1},
    [ADCGS_EVAL_CROP_PSNR] = {"crop_psnr", "  crop", " dB", 2, CROP, 0},
    [ADCGS_EVAL_CROP_SSIM] = {"crop_ssim", "", "", 4, CROP, 0},
    [ADCGS_EVAL_MILLISECONDS] = {"milliseconds", "", "", -1, ALWAYS, 0},
};

static const struct {
    const char *name;
    int flags;
} metrics[] = {
    {"psnr", 0},
    {"ssim", 0},
    {"fitted-psnr", ADCGS_MEASURE_FITTED},
    {"ms-ssim", ADCGS_MEASURE_MS_SSIM},
    {"dynamic-psnr", ADCGS_MEASURE_DYNAMIC},
    {"fitted-dynamic-psnr", ADCGS_MEASURE_FITTED_DYNAMIC},
    {"static-variance", ADCGS_MEASURE_STATIC},
    {"flicker", ADCGS_MEASURE_FLICKER},
    {"all", ADCGS_MEASURE_ALL},
};

int adcgs_eval_parse_metrics(const char *text, int *measure)
{
    *measure = 0;
    for (;; text++) {
        const size_t length = strcspn(text, ",");
        size_t i = 0;
        while (i < ADCGS_COUNTOF(metrics) && (strlen(metrics[i].name) != length || strncmp(metrics[i].name, text, length)))
            i++;
        if (i == ADCGS_COUNTOF(metrics))
            return -1;
        *measure |= metrics[i].flags;
        text += length;
        if (!*text)
            return 0;
    }
}

static int is_shown(const adcgs_eval_report *r, int c)
{
    const int wanted = columns[c].wanted;
    return wanted == ALWAYS || (wanted == CROP ? r->box != NULL : (r->measure & wanted) != 0);
}

/* ---- Sums ---- */

static void add_value(adcgs_eval_sum *sum, double value)
{
    sum->sum += value;
    sum->n++;
}

/** Rows may lack a value, except in columns that are always present: NaN there stays visible in the mean. */
static void add_row(adcgs_eval_sum *sums, const double *value)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        if (!isnan(value[c]) || columns[c].wanted == ALWAYS)
            add_value(&sums[c], value[c]);
}

/** Means over the rows with a value; NaN if there are none. */
static void find_means(const adcgs_eval_sum *sums, double *mean)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        mean[c] = sums[c].sum / sums[c].n;
}

static void make_row(double *value, const adcgs_view_score *score, const adcgs_crop *crop)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        value[c] = (double)NAN;
    value[ADCGS_EVAL_PSNR] = score->psnr;
    value[ADCGS_EVAL_SSIM] = score->ssim;
    value[ADCGS_EVAL_FITTED_PSNR] = score->fitted_psnr;
    value[ADCGS_EVAL_MS_SSIM] = score->ms_ssim;
    value[ADCGS_EVAL_MS_SSIM_SCALES] = score->ms_ssim_scales;
    value[ADCGS_EVAL_DYNAMIC_PSNR] = score->temporal.dynamic_psnr;
    value[ADCGS_EVAL_FITTED_DYNAMIC_PSNR] = score->fitted_dynamic_psnr;
    value[ADCGS_EVAL_FLICKER] = score->temporal.flicker;
    value[ADCGS_EVAL_DYNAMIC_SHARE] = score->known_share;
    value[ADCGS_EVAL_MILLISECONDS] = 1e3 * score->seconds;
    if (crop->visible) {
        value[ADCGS_EVAL_CROP_PSNR] = crop->psnr;
        value[ADCGS_EVAL_CROP_SSIM] = crop->ssim;
    }
}

/* ---- CSV (RFC 4180, except that lines end with a newline alone) ---- */

static void csv_heading(const adcgs_eval_report *r)
{
    fputs("row,camera,name,time", r->table);
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        if (is_shown(r, c))
            fprintf(r->table, ",%s", columns[c].key);
    fputc('\n', r->table);
}

/** The rest of a row, with as many digits as in JSON. */
static void csv_values(const adcgs_eval_report *r, const double *value)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        if (is_shown(r, c))
            fprintf(r->table, isfinite(value[c]) ? ",%.10g" : ",", value[c]);
    fputc('\n', r->table);
}

static void csv_view(const adcgs_eval_report *r, const adcgs_view_score *score, const double *value)
{
    fprintf(r->table, "view,%u,", score->camera);
    adcgs_text_cell(r->table, score->view->camera.name);
    fprintf(r->table, ",%.10g", score->view->time);
    csv_values(r, value);
}

/* ---- JSON ---- */

/** of_camera 1: includes values that only the views of a camera together give. Views include these if they are known. */
static void json_values(adcgs_eval_report *r, const double *value, int of_camera)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++)
        if (is_shown(r, c) && (columns[c].is_of_camera <= of_camera || !isnan(value[c])))
            adcgs_json_real(&r->json, columns[c].key, value[c]);
}

static void json_view(adcgs_eval_report *r, const adcgs_view_score *score, const adcgs_crop *crop, const double *value)
{
    adcgs_json_open(&r->json, NULL, '{');
    adcgs_json_string(&r->json, "name", score->view->camera.name);
    adcgs_json_int(&r->json, "camera", score->camera);
    adcgs_json_real(&r->json, "time", score->view->time);
    if (crop->visible) {
        adcgs_json_open(&r->json, "crop", '[');
        for (int i = 0; i < 4; i++)
            adcgs_json_int(&r->json, NULL, crop->rectangle[i]);
        adcgs_json_close(&r->json);
    }
    json_values(r, value, 0);
    adcgs_json_close(&r->json);
}

static void json_begin(adcgs_eval_report *r)
{
    adcgs_json_init(&r->json);
    adcgs_json_open(&r->json, NULL, '{');
    adcgs_json_string(&r->json, "file", r->file);
    adcgs_json_string(&r->json, "scene", r->scene);
    adcgs_json_string(&r->json, "split", r->split);
    adcgs_json_int(&r->json, "bytes", (int64_t)r->bytes);
    adcgs_json_int(&r->json, "layers", r->layers);
    adcgs_json_real(&r->json, "decode_seconds", r->decode_seconds);
    if (r->box) {
        adcgs_json_open(&r->json, "crop_box", '[');
        for (int i = 0; i < 6; i++)
            adcgs_json_real(&r->json, NULL, i < 3 ? r->box->low[i] : r->box->high[i - 3]);
        adcgs_json_close(&r->json);
    }
    adcgs_json_open(&r->json, "views", '[');
}

static void json_cameras(adcgs_eval_report *r)
{
    adcgs_json_open(&r->json, "cameras", '[');
    for (uint32_t i = 0; i < r->n_cameras; i++) {
        adcgs_json_open(&r->json, NULL, '{');
        adcgs_json_int(&r->json, "camera", r->cameras[i].camera);
        adcgs_json_int(&r->json, "views", r->cameras[i].views);
        json_values(r, r->cameras[i].value, 1);
        adcgs_json_close(&r->json);
    }
    adcgs_json_close(&r->json);
}

static adcgs_status json_end(adcgs_eval_report *r, const double *mean, const adcgs_evaluation *e, adcgs_error *error)
{
    adcgs_json_close(&r->json);
    if (r->measure & ADCGS_MEASURE_TIME)
        json_cameras(r);
    if (r->box)
        adcgs_json_int(&r->json, "crop_views", r->of_all[ADCGS_EVAL_CROP_PSNR].n);
    json_values(r, mean, 1);
    adcgs_json_real(&r->json, "frames_per_second", e->frames_per_second);
    adcgs_json_close(&r->json);
    return adcgs_json_write(&r->json, stdout, "standard output", error);
}

/* ---- Text ---- */

/** which: 0: values of views, 1: of views together, 2: both. */
static void text_values(const adcgs_eval_report *r, const double *value, int which)
{
    for (int c = 0; c < ADCGS_EVAL_COLUMNS; c++) {
        const column *k = &columns[c];
        const int is_known = !which && !isnan(value[c]);
        if (!is_shown(r, c) || k->digits < 0 || (which != 2 && k->is_of_camera != which && !is_known))
            continue;
        if (isnan(value[c]))
            printf("%s %8s%*s", k->label, "-", (int)strlen(k->unit), "");
        else
            printf("%s %8.*f%s", k->label, k->digits, value[c], k->unit);
    }
    printf("\n");
}

/** True if the only requested measure over time is one that single views provide. */
static int only_known(const adcgs_eval_report *r)
{
    return (r->measure & ADCGS_MEASURE_TIME) == ADCGS_MEASURE_DYNAMIC && r->of_all[ADCGS_EVAL_DYNAMIC_SHARE].n;
}

static void text_end(const adcgs_eval_report *r, const double *mean, const adcgs_evaluation *e)
{
    char title[64];
    snprintf(title, sizeof title, "mean of %u %s views", e->n, r->split);
    printf("%-35s", title);
    text_values(r, mean, 2);
    if (r->box && r->of_all[ADCGS_EVAL_CROP_PSNR].n)
        printf("the box is seen in %u view%s\n", r->of_all[ADCGS_EVAL_CROP_PSNR].n, adcgs_s(r->of_all[ADCGS_EVAL_CROP_PSNR].n));
    else if (r->box)
        printf("no view sees the box\n");
    if ((r->measure & ADCGS_MEASURE_TIME) && !r->n_cameras && !only_known(r))
        printf("no camera has several views from one place: nothing is measured over time\n");
    printf("%llu bytes, decoded in %.3f s, %.1f frames per second\n", (unsigned long long)r->bytes, r->decode_seconds,
           e->frames_per_second);
}

/* ---- The whole report ---- */

adcgs_status adcgs_eval_report_open(adcgs_eval_report *r, adcgs_error *error)
{
    const int on_stdout = r->csv && !strcmp(r->csv, "-");
    r->as_text = !r->as_json && !on_stdout;
    if (on_stdout)
        r->table = stdout;
    if (!r->csv || on_stdout)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_atomic_open(&r->atomic, r->csv, error));
    r->table = r->atomic.file;
    return ADCGS_OK;
}

void adcgs_eval_report_begin(adcgs_eval_report *r)
{
    if (r->as_json)
        json_begin(r);
    if (r->table)
        csv_heading(r);
}

/** After the last view of a camera: its means, with the values of its views together. */
static adcgs_status report_camera(adcgs_eval_report *r, const adcgs_temporal_total *total, adcgs_error *error)
{
    adcgs_eval_camera *grown = realloc(r->cameras, ((size_t)r->n_cameras + 1) * sizeof *grown);
    if (!grown)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u cameras", r->n_cameras + 1);
    r->cameras = grown;
    adcgs_eval_camera *c = &grown[r->n_cameras++];
    const adcgs_eval_column together[3] = {ADCGS_EVAL_DYNAMIC_SHARE, ADCGS_EVAL_STATIC_VARIANCE, ADCGS_EVAL_TRUTH_VARIANCE};
    const double values[3] = {total->dynamic_share, total->static_variance, total->truth_variance};
    *c = (adcgs_eval_camera){.camera = r->camera, .views = total->views};
    find_means(r->of_camera, c->value);
    for (int i = 0; i < 3; i++) {
        if (!isnan(c->value[together[i]])) /* views provide it */
            continue;
        c->value[together[i]] = values[i];
        if (!isnan(values[i]))
            add_value(&r->of_all[together[i]], values[i]);
    }
    if (r->table) {
        fprintf(r->table, "camera,%u,,", r->camera);
        csv_values(r, c->value);
    }
    if (r->as_text && (r->measure & (ADCGS_MEASURE_DYNAMIC | ADCGS_MEASURE_STATIC))) {
        printf("camera %u, %u view%s:", r->camera, total->views, adcgs_s(total->views));
        text_values(r, c->value, 1);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_eval_report_view(adcgs_eval_report *r, const adcgs_view_score *score, const adcgs_crop *crop,
                                    adcgs_error *error)
{
    double value[ADCGS_EVAL_COLUMNS];
    make_row(value, score, crop);
    if (score->camera != r->camera)
        memset(r->of_camera, 0, sizeof r->of_camera);
    r->camera = score->camera;
    add_row(r->of_all, value);
    add_row(r->of_camera, value);
    if (r->as_json)
        json_view(r, score, crop, value);
    if (r->table)
        csv_view(r, score, value);
    if (r->as_text) {
        adcgs_text_column(stdout, score->view->camera.name, NAME_WIDTH);
        printf(" %8.3f s", score->view->time);
        text_values(r, value, 0);
    }
    return score->of_camera ? report_camera(r, score->of_camera, error) : ADCGS_OK;
}

static adcgs_status csv_end(adcgs_eval_report *r, const double *mean, adcgs_error *error)
{
    fputs("mean,,,", r->table);
    csv_values(r, mean);
    return r->atomic.file ? adcgs_atomic_commit(&r->atomic, error) : ADCGS_OK;
}

adcgs_status adcgs_eval_report_end(adcgs_eval_report *r, const adcgs_evaluation *evaluation, adcgs_error *error)
{
    double mean[ADCGS_EVAL_COLUMNS];
    find_means(r->of_all, mean);
    if (r->as_text)
        text_end(r, mean, evaluation);
    if (r->table)
        ADCGS_TRY(csv_end(r, mean, error));
    return r->as_json ? json_end(r, mean, evaluation, error) : ADCGS_OK;
}

void adcgs_eval_report_clear(adcgs_eval_report *r)
{
    adcgs_atomic_abort(&r->atomic);
    adcgs_json_clear(&r->json);
    free(r->cameras);
    r->cameras = NULL;
    r->n_cameras = 0;
}
