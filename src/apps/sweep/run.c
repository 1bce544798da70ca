/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One run of a sweep: starts the encoder, the evaluation and the compressors, and stores their reports. */
#include "config.h"

#include "apps/sweep/run.h"

#include "scene/camera_json.h"
#include "system/atomic.h"
#include "system/text.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Files of a run ---- */

void adcgs_sweep_path(char path[ADCGS_SWEEP_PATH], const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *suffix)
{
    snprintf(path, ADCGS_SWEEP_PATH, "%s/%s%s", sweep->directory, run->tag, suffix);
}

static void drop(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *suffix)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(path, sweep, run, suffix);
    unlink(path);
}

/** Bytes of a file; NaN if there is none. */
static double size_of(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *suffix)
{
    char path[ADCGS_SWEEP_PATH];
    struct stat s;
    adcgs_sweep_path(path, sweep, run, suffix);
    return stat(path, &s) == 0 ? (double)s.st_size : (double)NAN;
}

/* Neither threads nor a shared beginning change a result. */
json_t *adcgs_sweep_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run)
{
    char *const scene = adcgs_text_utf8(sweep->scene); /* all other values have been checked, and are ASCII */
    json_t *const settings =
        json_pack("{s:s, s:s, s:s, s:i, s:f, s:s, s:f, s:s, s:i, s:i, s:s*, s:s*}", "scene", scene, "preset",
                  sweep->preset ? sweep->preset : "", "set", sweep->set ? sweep->set : "", "iterations", sweep->iterations,
                  "lambda", run->lambda, "choice", run->choice, "seed", run->seed, "without", run->without, "uncompressed",
                  run->uncompressed, "beginning", run->beginning, "dataset", sweep->dataset, "frames", sweep->frames);
    if (sweep->fixed)
        json_object_set_new(settings, "fixed", json_true());
    free(scene);
    return settings;
}

adcgs_status adcgs_sweep_save(json_t *root, const char *path, adcgs_error *error)
{
    adcgs_atomic file;
    adcgs_status status =
        root ? adcgs_atomic_open(&file, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (status == ADCGS_OK) {
        const int bad =
            json_dumpf(root, file.file, JSON_INDENT(2) | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(12)) && !ferror(file.file);
        if (bad) {
            adcgs_atomic_abort(&file);
            status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
        } else
            status = adcgs_atomic_commit(&file, error);
    }
    json_decref(root);
    return status;
}

int adcgs_sweep_same_settings(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const json_t *root)
{
    json_t *const wanted = adcgs_sweep_settings(sweep, run);
    const int same = wanted && json_equal(json_object_get(root, "settings"), wanted);
    json_decref(wanted);
    return same;
}

/* ---- Running ---- */

adcgs_status adcgs_sweep_call(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_command *c, const char *out,
                              adcgs_error *error)
{
    char log[ADCGS_SWEEP_PATH];
    int code = 0;
    adcgs_sweep_path(log, sweep, run, ".log");
    ADCGS_TRY(adcgs_sweep_spawn(c->argv, out, log, &code, error));
    const adcgs_status why = code == 2   ? ADCGS_ERR_USAGE
                             : code == 4 ? ADCGS_ERR_DATA
                             : code == 5 ? ADCGS_ERR_UNSUPPORTED
                                         : ADCGS_ERR_IO;
    return code ? adcgs_fail(error, why, "%s: %s ended with exit status %d; see %s", run->tag, c->argv[0], code, log) : ADCGS_OK;
}

/** *found: 1 if an earlier sweep left this run unfinished, with these settings. If not, records that it begins now. */
static adcgs_status find_unfinished(const adcgs_sweep *sweep, const adcgs_sweep_run *run, int *found, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_error ignored;
    adcgs_sweep_path(path, sweep, run, ".partial.json");
    json_t *root = NULL;
    if (sweep->resume)
        adcgs_json_load(&root, path, &ignored);
    *found = root && adcgs_sweep_same_settings(sweep, run, root) && size_of(sweep, run, ".partial") > 0;
    json_decref(root);
    if (*found)
        return ADCGS_OK;
    drop(sweep, run, ".partial");
    return adcgs_sweep_save(json_pack("{s:o}", "settings", adcgs_sweep_settings(sweep, run)), path, error);
}

static adcgs_status encode(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_sweep_run *from, const char *out,
                           adcgs_error *error)
{
    char program[ADCGS_SWEEP_PATH], file[ADCGS_SWEEP_PATH], begin[ADCGS_SWEEP_PATH], partial[ADCGS_SWEEP_PATH],
        raw[ADCGS_SWEEP_PATH];
    char own[ADCGS_SWEEP_NAME];
    int unfinished;
    adcgs_command c = {.n = 0};
    ADCGS_TRY(find_unfinished(sweep, run, &unfinished, error));
    snprintf(program, sizeof program, "%s/adcgs-enc", sweep->programs);
    adcgs_sweep_path(file, sweep, run, run->beginning ? ".checkpoint" : ".adcgs");
    adcgs_sweep_path(partial, sweep, run, ".partial");
    adcgs_sweep_path(raw, sweep, run, ".raw");
    if (from)
        adcgs_sweep_path(begin, sweep, from, ".checkpoint");
    adcgs_command_word(&c, program);
    adcgs_command_option(&c, run->beginning ? "--beginning" : "--output", file);
    adcgs_command_option(&c, "--checkpoint", partial);
    adcgs_command_option(&c, "--resume", unfinished ? partial : from ? begin : NULL);
    adcgs_command_option(&c, "--preset", adcgs_sweep_choice_find(run->choice, "preset", own) ? NULL : sweep->preset);
    adcgs_command_choice(&c, run, NULL);
    if (sweep->fixed)
        adcgs_command_word(&c, "--fixed");
    adcgs_command_settings(&c, sweep, run);
    adcgs_command_option(&c, "--dataset", sweep->dataset);
    adcgs_command_option(&c, "--frames", sweep->frames);
    adcgs_command_option(&c, "--without", run->without);
    adcgs_command_option(&c, "--uncompressed", run->uncompressed ? raw : NULL);
    adcgs_command_number(&c, "--lambda", run->lambda, 0);
    adcgs_command_number(&c, "--seed", run->seed, 0);
    adcgs_command_number(&c, "--iterations", sweep->iterations, 1);
    adcgs_command_threads(&c, sweep, run);
    adcgs_command_word(&c, "--json");
    adcgs_command_word(&c, "--");
    adcgs_command_word(&c, sweep->scene);
    return adcgs_sweep_call(sweep, run, &c, out, error);
}

/** Begins a command line that evaluates a run's stream, without the stream and the metrics. The caller holds program. */
static void begin_evaluation(adcgs_command *c, const adcgs_sweep *sweep, const adcgs_sweep_run *run,
                             char program[ADCGS_SWEEP_PATH])
{
    static const char *const of_speed[] = {"threads", "cpu", NULL};
    snprintf(program, ADCGS_SWEEP_PATH, "%s/adcgs-eval", sweep->programs);
    adcgs_command_word(c, program);
    adcgs_command_option(c, "--dataset", sweep->dataset);
    adcgs_command_option(c, "--frames", sweep->frames);
    adcgs_command_choice(c, run, of_speed);
    adcgs_command_threads(c, sweep, run);
}

adcgs_status adcgs_sweep_evaluate(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *file, const char *option,
                                  int count, const char *out, adcgs_error *error)
{
    char program[ADCGS_SWEEP_PATH];
    adcgs_command c = {.n = 0};
    begin_evaluation(&c, sweep, run, program);
    if (option)
        adcgs_command_number(&c, option, count, 1);
    adcgs_command_option(&c, "--metrics", "dynamic-psnr");
    adcgs_command_word(&c, "--json");
    adcgs_command_word(&c, "--");
    adcgs_command_word(&c, file);
    adcgs_command_word(&c, sweep->scene);
    return adcgs_sweep_call(sweep, run, &c, out, error);
}

adcgs_status adcgs_sweep_draw_views(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *folder, adcgs_error *error)
{
    adcgs_command c = {.n = 0};
    char program[ADCGS_SWEEP_PATH], file[ADCGS_SWEEP_PATH];
    begin_evaluation(&c, sweep, run, program);
    adcgs_sweep_path(file, sweep, run, ".adcgs");
    adcgs_command_option(&c, "--images", folder);
    adcgs_command_word(&c, "--beside");
    adcgs_command_word(&c, "--quiet");
    adcgs_command_word(&c, "--");
    adcgs_command_word(&c, file);
    adcgs_command_word(&c, sweep->scene);
    return adcgs_sweep_call(sweep, run, &c, "/dev/null", error);
}

/** Runs a general-purpose compressor on the uncompressed model. A missing compressor is no error; there is no file then. */
static adcgs_status compress(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *program, const char *level,
                             const char *suffix, adcgs_error *error)
{
    char raw[ADCGS_SWEEP_PATH], packed[ADCGS_SWEEP_PATH], log[ADCGS_SWEEP_PATH];
    adcgs_command c = {.n = 0};
    int code = 0;
    adcgs_sweep_path(raw, sweep, run, ".raw");
    adcgs_sweep_path(packed, sweep, run, suffix);
    adcgs_sweep_path(log, sweep, run, ".log");
    adcgs_command_word(&c, program);
    adcgs_command_word(&c, level);
    adcgs_command_word(&c, "-c");
    adcgs_command_word(&c, raw);
    ADCGS_TRY(adcgs_sweep_spawn(c.argv, packed, log, &code, error));
    if (code != 0)
        unlink(packed);
    return ADCGS_OK;
}

/* Writes the result file: the settings, and the programs' own reports. It comes last, so that its presence means a finished
   run. */
static adcgs_status write_result(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const char *encoded, const char *evaluated,
                                 adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(path, sweep, run, ".json");
    if (run->beginning)
        return adcgs_sweep_save(json_pack("{s:o}", "settings", adcgs_sweep_settings(sweep, run)), path, error);
    json_t *encoder, *evaluation;
    ADCGS_TRY(adcgs_json_load(&encoder, encoded, error));
    const adcgs_status status = adcgs_json_load(&evaluation, evaluated, error);
    if (status != ADCGS_OK) {
        json_decref(encoder);
        return status;
    }
    return adcgs_sweep_save(json_pack("{s:o, s:o, s:o}", "settings", adcgs_sweep_settings(sweep, run), "encoder", encoder,
                                      "evaluation", evaluation),
                            path, error);
}

adcgs_status adcgs_sweep_execute(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_sweep_run *from,
                                 adcgs_error *error)
{
    char encoded[ADCGS_SWEEP_PATH], evaluated[ADCGS_SWEEP_PATH], file[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(encoded, sweep, run, ".enc.part");
    adcgs_sweep_path(evaluated, sweep, run, ".eval.part");
    adcgs_sweep_path(file, sweep, run, ".adcgs");
    drop(sweep, run, ".log");
    drop(sweep, run, ".json");
    drop(sweep, run, ".portions.json"); /* of the stream that is made again */
    adcgs_status status = encode(sweep, run, from, encoded, error);
    if (status == ADCGS_OK && !run->beginning)
        status = adcgs_sweep_evaluate(sweep, run, file, NULL, 0, evaluated, error);
    if (status == ADCGS_OK && run->uncompressed)
        status = compress(sweep, run, "zstd", "-19", ".raw.zst", error);
    if (status == ADCGS_OK && run->uncompressed)
        status = compress(sweep, run, "xz", "-9e", ".raw.xz", error);
    if (status == ADCGS_OK)
        status = write_result(sweep, run, encoded, evaluated, error);
    if (status == ADCGS_OK) {
        drop(sweep, run, ".partial");
        drop(sweep, run, ".partial.json");
    }
    unlink(encoded);
    unlink(evaluated);
    return status;
}

/* ---- Results ---- */

double adcgs_sweep_number(const json_t *report, const char *name)
{
    const json_t *const value = json_object_get(report, name);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

/** Adds up the bytes: the first layer, which is required for rendering, apart from the others. */
static void take_components(double *f, const json_t *components)
{
    static const struct {
        const char *name;
        adcgs_figure figure;
    } known[] = {{"networks", ADCGS_FIGURE_NETWORKS},
                 {"geometry", ADCGS_FIGURE_GEOMETRY},
                 {"layer0", ADCGS_FIGURE_BASE},
                 {"layer", ADCGS_FIGURE_DETAIL},
                 {"", ADCGS_FIGURE_REST}};
    const char *name;
    const json_t *value;
    for (size_t i = 0; json_object_size(components) && i < ADCGS_COUNTOF(known); i++)
        f[known[i].figure] = 0;
    for (void *at = json_object_iter((json_t *)(uintptr_t)components); at;
         at = json_object_iter_next((json_t *)(uintptr_t)components, at)) {
        size_t i = 0;
        name = json_object_iter_key(at);
        value = json_object_iter_value(at);
        while (strncmp(name, known[i].name, strlen(known[i].name)) != 0)
            i++;
        f[known[i].figure] += json_number_value(value);
    }
}

static void take_figures(const adcgs_sweep *sweep, adcgs_sweep_run *run, const json_t *root)
{
    const json_t *const encoder = json_object_get(root, "encoder"), *const evaluation = json_object_get(root, "evaluation");
    double *const f = run->figure;
    f[ADCGS_FIGURE_BYTES] = adcgs_sweep_number(encoder, "bytes");
    take_components(f, json_object_get(encoder, "components"));
    f[ADCGS_FIGURE_NETWORKS32] = f[ADCGS_FIGURE_BYTES] - f[ADCGS_FIGURE_NETWORKS] + 4 * adcgs_sweep_number(encoder, "weights");
    f[ADCGS_FIGURE_SECONDS] = adcgs_sweep_number(encoder, "cpu_seconds");
    f[ADCGS_FIGURE_PSNR] = adcgs_sweep_number(evaluation, "psnr");
    f[ADCGS_FIGURE_SSIM] = adcgs_sweep_number(evaluation, "ssim");
    f[ADCGS_FIGURE_MOVING] = adcgs_sweep_number(evaluation, "dynamic_psnr"); /* results of earlier versions lack it, too */
    f[ADCGS_FIGURE_SPEED] = adcgs_sweep_number(evaluation, "frames_per_second");
    f[ADCGS_FIGURE_OBJECTIVE] = adcgs_sweep_number(encoder, "objective");
    if (!run->uncompressed)
        return;
    f[ADCGS_FIGURE_RAW] = size_of(sweep, run, ".raw");
    f[ADCGS_FIGURE_ZSTD] = size_of(sweep, run, ".raw.zst");
    f[ADCGS_FIGURE_XZ] = size_of(sweep, run, ".raw.xz");
}

/** Checks that the files of a run are those of its result file. */
static adcgs_status check_files(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const json_t *root, const char *path,
                                adcgs_error *error)
{
    const double *const f = run->figure;
    if (run->beginning)
        return size_of(sweep, run, ".checkpoint") > 0 ? ADCGS_OK
                                                      : adcgs_fail(error, ADCGS_ERR_DATA, "%s: its state file is missing", path);
    if (!(f[ADCGS_FIGURE_BYTES] > 0.0) || isnan(f[ADCGS_FIGURE_PSNR]))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no size or no PSNR in it", path);
    if (size_of(sweep, run, ".adcgs") != f[ADCGS_FIGURE_BYTES])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s/%s.adcgs: missing, or not the file described in %s", sweep->directory,
                          run->tag, path);
    if (run->uncompressed && f[ADCGS_FIGURE_RAW] != adcgs_sweep_number(json_object_get(root, "encoder"), "uncompressed_bytes"))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s/%s.raw: missing, or not the file described in %s", sweep->directory,
                          run->tag, path);
    return ADCGS_OK;
}

adcgs_status adcgs_sweep_load(const adcgs_sweep *sweep, adcgs_sweep_run *run, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(path, sweep, run, ".json");
    json_t *root;
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    take_figures(sweep, run, root);
    adcgs_status status = adcgs_sweep_same_settings(sweep, run, root)
                              ? check_files(sweep, run, root, path, error)
                              : adcgs_fail(error, ADCGS_ERR_DATA, "%s: made with other settings", path);
    json_decref(root);
    if (status == ADCGS_OK)
        run->state = ADCGS_RUN_DONE;
    else
        for (int i = 0; i < ADCGS_FIGURE_COUNT; i++)
            run->figure[i] = (double)NAN;
    return status;
}
