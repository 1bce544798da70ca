/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-sweep: a grid of encodings, each decoded and measured, as table and chart. */
#include "config.h"

#include "tools/cli.h"
#include "tools/sweep.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct grid {
    double lambdas[ADCGS_SWEEP_LIST], ks[ADCGS_SWEEP_LIST];
    int n_lambdas, n_ks, n;
    adcgs_sweep_point points[ADCGS_SWEEP_LIST * ADCGS_SWEEP_LIST];
    pid_t child[ADCGS_SWEEP_LIST * ADCGS_SWEEP_LIST];
} grid;

/* "a,b,c"; returns how many, or -1. */
static int parse_list(const char *text, double min, double max, double out[ADCGS_SWEEP_LIST])
{
    int n = 0;
    for (;;) {
        char item[32];
        const size_t length = strcspn(text, ",");
        if (n == ADCGS_SWEEP_LIST || length >= sizeof item)
            return -1;
        memcpy(item, text, length);
        item[length] = '\0';
        if (adcgs_parse_real(item, min, max, &out[n++]) != 0)
            return -1;
        if (text[length] == '\0')
            return n;
        text += length + 1;
    }
}

static void fill(grid *g)
{
    for (int j = 0; j < ADCGS_MAX(g->n_ks, 1); j++)
        for (int i = 0; i < g->n_lambdas; i++)
            adcgs_sweep_point_init(&g->points[g->n++], g->lambdas[i], g->n_ks ? (int)g->ks[j] : 0);
}

/* The folder this program lies in, where its siblings are. */
static void find_programs(const char *argv0, char *out, size_t size)
{
    const ssize_t n = readlink("/proc/self/exe", out, size - 1);
    if (n > 0)
        out[n] = '\0';
    else
        snprintf(out, size, "%s", argv0);
    char *const slash = strrchr(out, '/');
    if (slash)
        *slash = '\0';
    else
        snprintf(out, size, ".");
}

static pid_t start(const adcgs_cli *cli, const adcgs_sweep *sweep, const adcgs_sweep_point *point)
{
    const pid_t child = fork();
    if (child == 0) {
        adcgs_error error;
        const adcgs_status status = adcgs_sweep_run(sweep, point, &error);
        _exit(status == ADCGS_OK ? 0 : adcgs_cli_fail(cli, &error));
    }
    return child;
}

/* Wait for one child; returns the index of its point or -1. */
static int reap(grid *g, int *code)
{
    int state = 0;
    const pid_t child = waitpid(-1, &state, 0);
    if (child < 0)
        return -1;
    *code = WIFEXITED(state) ? WEXITSTATUS(state) : 128;
    for (int i = 0; i < g->n; i++)
        if (g->child[i] == child)
            return i;
    return -1;
}

static void say(const adcgs_cli *cli, const adcgs_sweep_point *p, const char *how)
{
    adcgs_cli_note(cli, "%s: %.0f bytes, %.2f dB PSNR, %.4f SSIM%s", p->tag, p->bytes, p->psnr, p->ssim, how);
}

/* Run all points not yet done, some at a time. Returns the worst exit code. */
static int run_all(const adcgs_cli *cli, const adcgs_sweep *sweep, grid *g, int jobs)
{
    int next = 0, running = 0, worst = 0;
    while (next < g->n || running > 0) {
        while (running < jobs && next < g->n && !adcgs_interrupted()) {
            if (!g->points[next].done) {
                g->child[next] = start(cli, sweep, &g->points[next]);
                if (g->child[next] < 0)
                    return adcgs_cli_error(cli, ADCGS_ERR_IO, "cannot start a process: %s", strerror(errno));
                running++;
            }
            next++;
        }
        if (running == 0)
            break;
        int code = 0;
        const int i = reap(g, &code);
        if (i < 0)
            continue;
        running--;
        worst = ADCGS_MAX(worst, code);
        adcgs_error error;
        if (code == 0 && adcgs_sweep_load(sweep, &g->points[i], &error) != ADCGS_OK)
            worst = ADCGS_MAX(worst, adcgs_cli_fail(cli, &error));
        else if (code == 0)
            say(cli, &g->points[i], "");
    }
    return adcgs_interrupted() ? ADCGS_MAX(worst, 3) : worst;
}

static void take_finished(const adcgs_cli *cli, const adcgs_sweep *sweep, grid *g)
{
    for (int i = 0; i < g->n; i++) {
        adcgs_error ignored;
        if (adcgs_sweep_load(sweep, &g->points[i], &ignored) == ADCGS_OK)
            say(cli, &g->points[i], " (from before)");
    }
}

static int sweep_grid(const adcgs_cli *cli, const adcgs_sweep *sweep, grid *g, int jobs)
{
    int chart = 0;
    adcgs_error error;
    if (mkdir(sweep->directory, 0777) != 0 && errno != EEXIST)
        return adcgs_cli_error(cli, ADCGS_ERR_IO, "%s: cannot make the folder: %s", sweep->directory, strerror(errno));
    if (sweep->resume)
        take_finished(cli, sweep, g);
    adcgs_interrupt_catch();
    const int worst = run_all(cli, sweep, g, jobs);
    if (adcgs_sweep_write(sweep, g->points, g->n, &chart, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_cli_note(cli, "wrote %s/sweep.csv, sweep.json%s", sweep->directory,
                   chart ? ", sweep.svg" : "; no chart (is gnuplot there?)");
    return worst;
}

int main(int argc, char **argv)
{
    const char *lambdas = NULL, *ks = NULL, *directory = NULL, *preset = NULL;
    int iterations = 0, jobs = 1, threads = 0, resume = 0, first = 0;
    const adcgs_option options[] = {
        {"output", 'o', ADCGS_OPTION_STRING, &directory, 0, 0, "DIR", "folder for all results (required)", NULL, NULL},
        {"lambda", 'l', ADCGS_OPTION_STRING, &lambdas, 0, 0, "A,B,C", "values of the encoder's --lambda (required)", NULL, NULL},
        {"k", 0, ADCGS_OPTION_STRING, &ks, 0, 0, "A,B,C", "values of the encoder's --k (default: the preset's)", NULL, NULL},
        {"preset", 'p', ADCGS_OPTION_STRING, &preset, 0, 0, "NAME", "preset of the encoder (default: its own)", NULL, NULL},
        {"iterations", 'n', ADCGS_OPTION_INT, &iterations, 1, 10000000, "N", "of training (default: the preset's)", NULL, NULL},
        {"jobs", 'j', ADCGS_OPTION_INT, &jobs, 1, 64, "N", "encoders at a time (default: 1)", NULL, NULL},
        {"threads", 't', ADCGS_OPTION_INT, &threads, 0, 256, "N", "threads of each encoder (default: one per CPU)", NULL, NULL},
        {"resume", 0, ADCGS_OPTION_FLAG, &resume, 0, 0, NULL, "keep finished points that have the same settings", NULL, NULL},
    };
    const adcgs_cli cli = {.program = "adcgs-sweep",
                           .operands = "SCENE",
                           .summary = "Encode a scene at several rates, measure each decoded file, draw the curve.",
                           .details = "Runs adcgs-enc and adcgs-eval from the folder that adcgs-sweep itself lies in.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .min_operands = 1,
                           .max_operands = 1};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    if (!directory || !lambdas)
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "expected -o DIR and --lambda A,B,C; see --help");
    grid *const g = calloc(1, sizeof *g);
    if (!g)
        return adcgs_cli_error(&cli, ADCGS_ERR_MEMORY, "out of memory");
    g->n_lambdas = parse_list(lambdas, 0.0, 1000.0, g->lambdas);
    g->n_ks = ks ? parse_list(ks, 1.0, 16.0, g->ks) : 0;
    int code = 2;
    if (g->n_lambdas < 1 || g->n_ks < 0)
        code = adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "bad list \"%s\": expected numbers, separated by commas",
                               g->n_lambdas < 1 ? lambdas : ks);
    else {
        char programs[4096];
        find_programs(argv[0], programs, sizeof programs);
        const adcgs_sweep sweep = {.scene = argv[first], .directory = directory, .programs = programs, .preset = preset,
                                   .iterations = iterations, .threads = threads, .resume = resume};
        fill(g);
        code = sweep_grid(&cli, &sweep, g, jobs);
    }
    free(g);
    return code;
}
