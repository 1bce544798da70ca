/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-sweep: a grid of encodings, each decoded and measured, as table and chart. */
#include "config.h"

#include "cli/cli.h"
#include "layouts/open.h"
#include "sweep/sweep.h"
#include "tools/sweep_run.h"
#include "train/settings.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* ---- Running ---- */

static int write_all(const adcgs_cli *cli, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan)
{
    adcgs_error error;
    unsigned charts = 0;
    if (adcgs_sweep_write_tables(sweep, plan, &error) != ADCGS_OK || adcgs_sweep_draw(sweep, plan, &charts, &error) != ADCGS_OK ||
        adcgs_sweep_write_page(sweep, plan, charts, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_sweep_print(stdout, plan);
    if (adcgs_cli_flush(&error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_cli_note(cli, "wrote %s/index.html, sweep.csv, sweep.json%s%s%s%s", sweep->directory,
                   plan->n_stages ? ", ablation.csv" : "", plan->shown.n_portions ? ", portions.csv" : "",
                   plan->shown.n_views ? ", views.csv" : "",
                   charts ? ", charts as .svg and .pdf" : plan->n_curves ? "; no chart (is gnuplot there?)" : "");
    return 0;
}

static int run_sweep(const adcgs_cli *cli, const adcgs_sweep *sweep, int jobs)
{
    adcgs_error error;
    adcgs_sweep_plan *const plan = calloc(1, sizeof *plan);
    if (!plan)
        return adcgs_cli_error(cli, ADCGS_ERR_MEMORY, "out of memory");
    int code = 0;
    if (adcgs_sweep_plan_make(plan, sweep, &error) != ADCGS_OK || adcgs_sweep_add_against(plan, sweep, &error) != ADCGS_OK ||
        adcgs_sweep_add_tables(plan, sweep->tables, &error) != ADCGS_OK)
        code = adcgs_cli_fail(cli, &error);
    else if (mkdir(sweep->directory, 0777) != 0 && errno != EEXIST)
        code = adcgs_cli_error(cli, ADCGS_ERR_IO, "%s: cannot make the folder: %s", sweep->directory, strerror(errno));
    else {
        if (sweep->resume)
            adcgs_sweep_take_finished(cli, sweep, plan);
        adcgs_interrupt_catch();
        const int ran = adcgs_sweep_run_all(cli, sweep, plan, jobs), shown = adcgs_sweep_show_one(cli, sweep, plan),
                  written = write_all(cli, sweep, plan);
        code = ADCGS_MAX(ADCGS_MAX(ran, shown), written);
    }
    adcgs_sweep_plan_clear(plan);
    free(plan);
    return code;
}

/* ---- Command line ---- */

static int compare_double(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** "all", "none" or some of the names, separated by commas; -1 if it is none of these. */
static int parse_yardsticks(const char *text)
{
    static const struct {
        const char *name;
        int bits;
    } known[] = {{"none", 0},
                 {"all", ADCGS_YARD_ALL},
                 {"networks", ADCGS_YARD_NETWORKS},
                 {"uncompressed", ADCGS_YARD_UNCOMPRESSED},
                 {"gaussians", ADCGS_YARD_GAUSSIANS}};
    int bits = 0;
    for (;; text++) {
        const size_t length = strcspn(text, ",");
        size_t i = 0;
        while (i < ADCGS_COUNTOF(known) && (strlen(known[i].name) != length || memcmp(known[i].name, text, length) != 0))
            i++;
        if (i == ADCGS_COUNTOF(known))
            return -1;
        bits |= known[i].bits;
        text += length;
        if (!*text)
            return bits;
    }
}

/** The lists as the user gave them; NULL: not given. */
typedef struct lists {
    const char *lambdas, *ks, *grid, *seeds, *yardsticks;
} lists;

/** What every run would refuse is refused before the first. */
static int check_settings(const adcgs_cli *cli, const adcgs_sweep *sweep)
{
    adcgs_error error;
    adcgs_frame_range frames;
    adcgs_status status = adcgs_sweep_grid_check(&sweep->grid, sweep->preset, sweep->set, &error);
    if (status == ADCGS_OK && sweep->frames)
        status = adcgs_frames_parse(&frames, sweep->frames, &error);
    if (status == ADCGS_OK && access(sweep->scene, R_OK))
        status = adcgs_fail(&error, ADCGS_ERR_IO, "%s: cannot open the scene: %s", sweep->scene, strerror(errno));
    return status == ADCGS_OK ? -1 : adcgs_cli_fail(cli, &error);
}

/** The axes of --k and --grid, of which none may have an option that says something else. -1 to go on. */
static int parse_grid(const adcgs_cli *cli, const lists *l, adcgs_sweep *sweep)
{
    const struct {
        const char *axis;
        int given;
    } twice[] = {{"preset", sweep->preset != NULL}, {"iterations", sweep->iterations != 0}, {"threads", sweep->threads != 0}};
    char text[256], choice[ADCGS_SWEEP_CHOICE], value[ADCGS_SWEEP_NAME];
    adcgs_error error;
    if (l->ks && snprintf(text, sizeof text, "k=%s", l->ks) >= (int)sizeof text)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--k: expected at most %d numbers", ADCGS_SWEEP_LIST);
    if ((l->ks && adcgs_sweep_grid_parse(&sweep->grid, text, &error) != ADCGS_OK) ||
        (l->grid && adcgs_sweep_grid_parse(&sweep->grid, l->grid, &error) != ADCGS_OK))
        return adcgs_cli_fail(cli, &error);
    adcgs_sweep_grid_choice(choice, &sweep->grid, 0);
    for (size_t i = 0; i < ADCGS_COUNTOF(twice); i++)
        if (twice[i].given && adcgs_sweep_choice_find(choice, twice[i].axis, value))
            return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--grid: %s has one value for all runs, by --%s", twice[i].axis,
                                   twice[i].axis);
    return -1;
}

/** -1 to go on, else the exit code to leave with. */
static int parse_lists(const adcgs_cli *cli, const lists *l, adcgs_sweep *sweep)
{
    const struct {
        const char *text, *setting;
        double *out;
        int *n;
    } each[] = {{l->lambdas, "lambda", sweep->lambda, &sweep->n_lambda},
                {l->seeds, "seed", sweep->seed, &sweep->n_seed}};
    for (size_t i = 0; i < ADCGS_COUNTOF(each); i++) {
        const adcgs_setting *s = adcgs_setting_find(each[i].setting);
        const int whole = s->kind != ADCGS_SETTING_REAL;
        *each[i].n = each[i].text ? parse_list(each[i].text, s->min, s->max, each[i].out) : 0;
        for (int j = 0; whole && j < *each[i].n; j++)
            if (each[i].out[j] != (double)(int64_t)each[i].out[j])
                *each[i].n = -1;
        if (*each[i].n < 0)
            return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "bad list \"%s\": expected at most %d %snumbers from %g to %g, with "
                                   "commas between", each[i].text, ADCGS_SWEEP_LIST, whole ? "whole " : "", s->min, s->max);
    }
    qsort(sweep->lambda, (size_t)sweep->n_lambda, sizeof *sweep->lambda, compare_double);
    const int bad = parse_grid(cli, l, sweep);
    if (bad >= 0)
        return bad;
    sweep->yardsticks = parse_yardsticks(l->yardsticks);
    if (sweep->yardsticks < 0)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--yardsticks %s: expected all, none, or some of networks, uncompressed and "
                               "gaussians", l->yardsticks);
    return -1;
}

static const adcgs_cli program = {
    .program = "adcgs-sweep",
    .operands = "SCENE",
    .summary = "Encode a scene at several rates, measure each decoded file, draw the curve.",
    .details = "Runs adcgs-enc, adcgs-eval and adcgs-info from the folder that adcgs-sweep itself lies in.",
    .min_operands = 1,
    .max_operands = 1,
};

/** -1 to go on, else the exit code to leave with. */
static int parse(adcgs_cli *cli, adcgs_sweep *sweep, int *jobs, int argc, char **argv)
{
    lists l = {.yardsticks = "all"};
    int first = 0, dataset = 0, has_dataset = 0;
    const adcgs_setting *const iterations = adcgs_setting_find("iterations");
    const char *names[ADCGS_SETTING_NAMES + 1];
    adcgs_setting_names(names);
    const adcgs_option options[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &sweep->directory, 0, 0, "DIR", "folder for all results (required)", NULL, NULL},
        {"lambda", 'l', ADCGS_OPTION_STRING, &l.lambdas, 0, 0, "A,B,C",
         "values of the encoder's --lambda (required, but for\n--ablation)", NULL, NULL},
        {"k", 0, ADCGS_OPTION_STRING, &l.ks, 0, 0, "A,B,C", "values of the encoder's --k (default: the preset's)", NULL, NULL},
        {"grid", 0, ADCGS_OPTION_STRING, &l.grid, 0, 0, "NAME=A,B,...",
         "a curve for each choice of values of any settings of the\nencoder, and of preset, time-limit, segment, key, threads\n"
         "and cpu; blanks between two such lists", names, NULL},
        {"seeds", 0, ADCGS_OPTION_STRING, &l.seeds, 0, 0, "A,B,C",
         "train each point with these seeds; figures are means\n(default: the encoder's seed)", NULL, NULL},
        {"yardsticks", 0, ADCGS_OPTION_STRING, &l.yardsticks, 0, 0, "NAME,...",
         "what to compare with: networks (of 32 bits; no run),\nuncompressed (two runs; by zstd and xz), gaussians (a\n"
         "curve and a run); all (default) or none", NULL, NULL},
        {"against", 0, ADCGS_OPTION_FILE, &sweep->against, 0, 0, "DIR,...",
         "compare with earlier sweeps of the scene, of whatever\nversion or settings, by what they wrote", NULL, NULL},
        {"add", 0, ADCGS_OPTION_STRING, &sweep->tables, 0, 0, "NAME=FILE,...",
         "draw other methods' tables beside, CSV with columns bytes\nand psnr, maybe ssim, dynamic_psnr, cpu_seconds,\n"
         "frames_per_second, source", NULL, NULL},
        {"ablation", 0, ADCGS_OPTION_FLAG, &sweep->ablation, 0, 0, NULL,
         "train the stages of the method one after another, and\n5, 10 and 15 primitives per anchor (nine runs)", NULL, NULL},
        {"preset", 'p', ADCGS_OPTION_STRING, &sweep->preset, 0, 0, "NAME", "preset of the encoder (default: its own)",
         adcgs_train_presets, NULL},
        {"fixed", 0, ADCGS_OPTION_FLAG, &sweep->fixed, 0, 0, NULL, "sizes of the preset, as adcgs-enc --fixed", NULL, NULL},
        {"set", 0, ADCGS_OPTION_STRING, &sweep->set, 0, 0, "NAME=VALUE,...", "settings of the encoder", names, NULL},
        {"dataset", 0, ADCGS_OPTION_CHOICE, &dataset, 0, 0, "KIND", "kind of the scene, as for adcgs-enc", adcgs_dataset_names,
         &has_dataset},
        {"frames", 0, ADCGS_OPTION_STRING, &sweep->frames, 0, 0, "A:B:STEP", "frames of the scene, as for adcgs-enc", NULL, NULL},
        {"iterations", 'n', ADCGS_OPTION_INT, &sweep->iterations, iterations->min, iterations->max, "N",
         "of training (default: the preset's)", NULL, NULL},
        {"jobs", 'j', ADCGS_OPTION_INT, jobs, 1, 64, "N", "encoders at a time (default: 1)", NULL, NULL},
        {"threads", 't', ADCGS_OPTION_INT, &sweep->threads, 0, 256, "N", "threads of each encoder (default: one per CPU)", NULL,
         NULL},
        {"resume", 0, ADCGS_OPTION_FLAG, &sweep->resume, 0, 0, NULL,
         "keep what an earlier sweep finished with the same\nsettings, go on with what it did not", NULL, NULL},
    };
    cli->options = options;
    cli->n_options = ADCGS_COUNTOF(options);
    const int leave = adcgs_cli_parse(cli, argc, argv, &first);
    cli->n_options = 0; /* the table ends with this function */
    if (leave >= 0)
        return leave;
    if (!sweep->directory || (!l.lambdas && !sweep->ablation))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "expected -o DIR and --lambda A,B,C; see --help");
    if ((sweep->against || sweep->tables) && !l.lambdas)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: expected --lambda, too: there is no curve to compare",
                               sweep->against ? "--against" : "--add");
    sweep->scene = argv[first];
    sweep->dataset = has_dataset ? adcgs_dataset_names[dataset] : NULL;
    const int bad = parse_lists(cli, &l, sweep);
    return bad >= 0 ? bad : check_settings(cli, sweep);
}

/** The command line as text, of what is too long the beginning. */
static void join(char *text, size_t size, int argc, char **argv)
{
    size_t n = 0;
    text[0] = '\0';
    for (int i = 0; i < argc && n < size - 1; i++)
        n += (size_t)snprintf(text + n, size - n, "%s%s", i ? " " : "", i ? argv[i] : program.program);
}

int main(int argc, char **argv)
{
    char programs[ADCGS_SWEEP_PATH], command[480];
    adcgs_sweep sweep = {.programs = programs, .command = command};
    int jobs = 1, quiet = 0;
    adcgs_cli cli = program;
    cli.quiet = &quiet;
    const int code = parse(&cli, &sweep, &jobs, argc, argv);
    if (code >= 0)
        return code;
    find_programs(argv[0], programs, sizeof programs);
    join(command, sizeof command, argc, argv);
    return run_sweep(&cli, &sweep, jobs);
}
