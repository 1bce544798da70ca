/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One point of a sweep: runs the encoder and the evaluation, keeps what they report. */
#include "config.h"

#include "tools/sweep.h"

#include "io/atomic.h"
#include "tools/cli.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define PATH_BYTES 4096
#define ARGS_MAX 24

void adcgs_sweep_point_init(adcgs_sweep_point *point, double lambda, int k)
{
    *point = (adcgs_sweep_point){.lambda = lambda, .k = k};
    const int n = snprintf(point->tag, sizeof point->tag, "lambda-%g", lambda);
    if (k)
        snprintf(point->tag + n, sizeof point->tag - (size_t)n, "-k-%d", k);
}

static void redirect(const char *path, int descriptor, int flags)
{
    const int file = open(path, O_WRONLY | O_CREAT | flags, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(126);
    close(file);
}

adcgs_status adcgs_sweep_spawn(char *const argv[], const char *out, const char *log, int *exit_code, adcgs_error *error)
{
    int state = 0;
    const pid_t child = fork();
    if (child < 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "cannot start %s: %s", argv[0], strerror(errno));
    if (child == 0) {
        if (out)
            redirect(out, STDOUT_FILENO, O_TRUNC);
        if (log)
            redirect(log, STDERR_FILENO, O_APPEND);
        execvp(argv[0], argv);
        _exit(127);
    }
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", argv[0], strerror(errno));
    *exit_code = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    return ADCGS_OK;
}

static void path_of(char path[PATH_BYTES], const adcgs_sweep *sweep, const adcgs_sweep_point *point, const char *suffix)
{
    snprintf(path, PATH_BYTES, "%s/%s%s", sweep->directory, point->tag, suffix);
}

static adcgs_status call(const adcgs_sweep *sweep, const adcgs_sweep_point *point, char *const argv[], const char *out,
                         adcgs_error *error)
{
    char log[PATH_BYTES];
    int code = 0;
    path_of(log, sweep, point, ".log");
    ADCGS_TRY(adcgs_sweep_spawn(argv, out, log, &code, error));
    if (code != 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: %s left with %d; see %s", point->tag, argv[0], code, log);
    return ADCGS_OK;
}

static adcgs_status encode(const adcgs_sweep *sweep, const adcgs_sweep_point *point, char *file, const char *out,
                           adcgs_error *error)
{
    char program[PATH_BYTES], lambda[32], k[16], iterations[16], threads[16];
    char *argv[ARGS_MAX];
    int n = 0;
    snprintf(program, sizeof program, "%s/adcgs-enc", sweep->programs);
    snprintf(lambda, sizeof lambda, "%.17g", point->lambda);
    snprintf(k, sizeof k, "%d", point->k);
    snprintf(iterations, sizeof iterations, "%d", sweep->iterations);
    snprintf(threads, sizeof threads, "%d", sweep->threads);
    const struct {
        const char *name, *value;
        int wanted;
    } given[] = {{"--output", file, 1},
                 {"--lambda", lambda, 1},
                 {"--k", k, point->k != 0},
                 {"--preset", sweep->preset, sweep->preset != NULL},
                 {"--iterations", iterations, sweep->iterations != 0},
                 {"--threads", threads, sweep->threads != 0}};
    argv[n++] = program;
    for (size_t i = 0; i < ADCGS_COUNTOF(given); i++)
        if (given[i].wanted) {
            argv[n++] = (char *)(uintptr_t)given[i].name;
            argv[n++] = (char *)(uintptr_t)given[i].value;
        }
    argv[n++] = (char *)(uintptr_t)"--json";
    argv[n++] = (char *)(uintptr_t)"--";
    argv[n++] = (char *)(uintptr_t)sweep->scene;
    argv[n] = NULL;
    return call(sweep, point, argv, out, error);
}

static adcgs_status evaluate(const adcgs_sweep *sweep, const adcgs_sweep_point *point, char *file, const char *out,
                             adcgs_error *error)
{
    char program[PATH_BYTES];
    snprintf(program, sizeof program, "%s/adcgs-eval", sweep->programs);
    char *argv[] = {program, (char *)(uintptr_t)"--json", (char *)(uintptr_t)"--", file, (char *)(uintptr_t)sweep->scene, NULL};
    return call(sweep, point, argv, out, error);
}

static json_t *settings_of(const adcgs_sweep *sweep, const adcgs_sweep_point *point)
{
    return json_pack("{s:s, s:s, s:i, s:f, s:i}", "scene", sweep->scene, "preset", sweep->preset ? sweep->preset : "",
                     "iterations", sweep->iterations, "lambda", point->lambda, "k", point->k);
}

static json_t *load(const char *path, adcgs_error *error)
{
    json_error_t where;
    json_t *const root = json_load_file(path, JSON_REJECT_DUPLICATES, &where);
    if (!root)
        adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s", path, where.text);
    return root;
}

/* The result file: the settings, and both programs' own reports. Written last, so that its presence means a finished point. */
static adcgs_status write_result(const adcgs_sweep *sweep, const adcgs_sweep_point *point, const char *encoded,
                                 const char *evaluated, adcgs_error *error)
{
    char path[PATH_BYTES];
    adcgs_atomic file;
    json_t *const encoder = load(encoded, error), *const evaluation = encoder ? load(evaluated, error) : NULL;
    if (!evaluation) {
        json_decref(encoder);
        return ADCGS_ERR_DATA;
    }
    json_t *const root =
        json_pack("{s:o, s:o, s:o}", "settings", settings_of(sweep, point), "encoder", encoder, "evaluation", evaluation);
    path_of(path, sweep, point, ".json");
    adcgs_status status =
        root ? adcgs_atomic_open(&file, path, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (status == ADCGS_OK) {
        const int bad = json_dumpf(root, file.file, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
        if (!bad)
            status = adcgs_atomic_commit(&file, error);
        else {
            adcgs_atomic_abort(&file);
            status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write", path);
        }
    }
    json_decref(root);
    return status;
}

adcgs_status adcgs_sweep_run(const adcgs_sweep *sweep, const adcgs_sweep_point *point, adcgs_error *error)
{
    char file[PATH_BYTES], log[PATH_BYTES], encoded[PATH_BYTES], evaluated[PATH_BYTES];
    path_of(file, sweep, point, ".adcgs");
    path_of(log, sweep, point, ".log");
    path_of(encoded, sweep, point, ".enc.part");
    path_of(evaluated, sweep, point, ".eval.part");
    unlink(log);
    adcgs_status status = encode(sweep, point, file, encoded, error);
    if (status == ADCGS_OK)
        status = evaluate(sweep, point, file, evaluated, error);
    if (status == ADCGS_OK)
        status = write_result(sweep, point, encoded, evaluated, error);
    unlink(encoded);
    unlink(evaluated);
    return status;
}

/* A number of a report; NaN if it is not there. */
static double number(const json_t *report, const char *name)
{
    const json_t *const value = json_object_get(report, name);
    return json_is_number(value) ? json_number_value(value) : (double)NAN;
}

adcgs_status adcgs_sweep_load(const adcgs_sweep *sweep, adcgs_sweep_point *point, adcgs_error *error)
{
    char path[PATH_BYTES], file[PATH_BYTES];
    struct stat found;
    path_of(path, sweep, point, ".json");
    path_of(file, sweep, point, ".adcgs");
    json_t *const root = load(path, error);
    if (!root)
        return ADCGS_ERR_DATA;
    json_t *const wanted = settings_of(sweep, point);
    const json_t *const encoder = json_object_get(root, "encoder"), *const evaluation = json_object_get(root, "evaluation");
    const int same = wanted && json_equal(json_object_get(root, "settings"), wanted);
    point->bytes = number(encoder, "bytes");
    point->training_seconds = number(encoder, "training_seconds");
    point->psnr = number(evaluation, "psnr");
    point->ssim = number(evaluation, "ssim");
    point->frames_per_second = number(evaluation, "frames_per_second");
    json_decref(wanted);
    json_decref(root);
    if (!same)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: made with other settings", path);
    if (!(point->bytes > 0.0) || isnan(point->psnr))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no size or no PSNR in it", path);
    if (stat(file, &found) != 0 || (double)found.st_size != point->bytes)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: missing, or not the file that %s tells of", file, path);
    point->done = 1;
    return ADCGS_OK;
}
