/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The command line of adcgs-sweep, parsed, and as words again. */
#include "config.h"

#include "apps/sweep/sweep_options.h"

#include "apps/shared/former_settings.h"
#include "scene/layouts/open.h"
#include "system/numbers.h"
#include "train/settings.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- Lists ---- */

/** Parses "a,b,c"; returns the number of elements, or -1. */
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

static int compare_double(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** Parses "all", "none" or some of the names, separated by commas; -1 for anything else. */
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

/** The lists as given by the user; NULL: not given. */
typedef struct lists {
    const char *lambdas, *ks, *grid, *seeds, *yardsticks;
} lists;

/** Checks settings that every run would refuse, before the first run. */
static int check_settings(const adcgs_cli *cli, const adcgs_sweep *sweep)
{
    adcgs_error error;
    adcgs_frame_range frames;
    adcgs_status status = adcgs_sweep_grid_check(&sweep->grid, sweep->preset, sweep->set, &error);
    if (status == ADCGS_OK && sweep->frames)
        status = adcgs_frames_parse(&frames, sweep->frames, &error);
    if (status == ADCGS_OK && access(sweep->scene, R_OK))
        status = adcgs_fail(&error, ADCGS_ERR_IO, "%s: cannot open the scene: %s", sweep->scene, strerror(errno));
    if (status == ADCGS_OK && sweep->set)
        adcgs_former_settings_report(cli, sweep->set);
    for (int i = 0; status == ADCGS_OK && i < sweep->grid.n; i++)
        adcgs_former_settings_report(cli, sweep->grid.axis[i].name);
    return status == ADCGS_OK ? -1 : adcgs_cli_fail(cli, &error);
}

/** Parses the axes of --k and --grid; none may contradict an option. Returns -1 to continue. */
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

/** Returns -1 to continue, else the exit code. */
static int parse_lists(const adcgs_cli *cli, const lists *l, adcgs_sweep *sweep)
{
    const struct {
        const char *text, *setting;
        double *out;
        int *n;
    } each[] = {{l->lambdas, "lambda", sweep->lambda, &sweep->n_lambda}, {l->seeds, "seed", sweep->seed, &sweep->n_seed}};
    for (size_t i = 0; i < ADCGS_COUNTOF(each); i++) {
        const adcgs_setting *s = adcgs_setting_find(each[i].setting);
        const int whole = s->kind != ADCGS_SETTING_REAL;
        *each[i].n = each[i].text ? parse_list(each[i].text, s->min, s->max, each[i].out) : 0;
        for (int j = 0; whole && j < *each[i].n; j++)
            if (each[i].out[j] != (double)(int64_t)each[i].out[j])
                *each[i].n = -1;
        if (*each[i].n < 0)
            return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                                   "bad list \"%s\": expected at most %d %snumbers from %g to %g, with "
                                   "commas between",
                                   each[i].text, ADCGS_SWEEP_LIST, whole ? "whole " : "", s->min, s->max);
    }
    qsort(sweep->lambda, (size_t)sweep->n_lambda, sizeof *sweep->lambda, compare_double);
    const int bad = parse_grid(cli, l, sweep);
    if (bad >= 0)
        return bad;
    sweep->yardsticks = l->yardsticks ? parse_yardsticks(l->yardsticks) : ADCGS_YARD_ALL;
    if (sweep->yardsticks < 0)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--yardsticks %s: expected all, none, or some of networks, uncompressed and "
                               "gaussians",
                               l->yardsticks);
    return -1;
}

/** Checks that a sweep can be made of the options. Returns -1 to continue. */
static int check_options(const adcgs_cli *cli, const adcgs_sweep_request *request, const lists *l)
{
    const adcgs_sweep *const sweep = &request->sweep;
    if (!sweep->directory || (!l->lambdas && !sweep->ablation))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "expected -o DIR and --lambda A,B,C; see --help");
    return -1;
}

/* ---- The command line as words ---- */

/** True for options that define the execution or the place of a sweep, not its contents. */
static int is_way(const char *name)
{
    static const char *const ways[] = {"output", "jobs", "resume", "list", "run", "collect"};
    for (size_t i = 0; i < ADCGS_COUNTOF(ways); i++)
        if (!strcmp(name, ways[i]))
            return 1;
    return 0;
}

/** Takes each option whose value differs from its default, which is none or 0. */
static void take_words(adcgs_sweep_words *w, const adcgs_option *options, size_t n)
{
    for (size_t i = 0; i < n && w->n < ADCGS_SWEEP_OPTIONS; i++) {
        const adcgs_option *const o = &options[i];
        if (o->kind == ADCGS_OPTION_FORMER)
            continue;
        const int is_text = o->kind == ADCGS_OPTION_STRING || o->kind == ADCGS_OPTION_FILE;
        const char *value = NULL;
        const int is_given = is_text ? *(const char *const *)o->target != NULL : o->given ? *o->given : *(const int *)o->target;
        if (is_way(o->name) || !is_given)
            continue;
        if (is_text)
            value = *(const char *const *)o->target;
        else if (o->kind == ADCGS_OPTION_CHOICE)
            value = o->choices[*(const int *)o->target];
        else if (o->kind == ADCGS_OPTION_INT && w->n_text < (int)ADCGS_COUNTOF(w->text)) {
            value = w->text[w->n_text++];
            snprintf(w->text[w->n_text - 1], sizeof w->text[0], "%d", *(const int *)o->target);
        }
        w->option[w->n].name = o->name;
        w->option[w->n++].value = value;
    }
}

/** Prints a word for a shell, quoted if a shell would interpret it. */
static void print_word(FILE *file, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, file);
        return;
    }
    fputc('\'', file);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", file);
        else
            fputc(*word, file);
    fputc('\'', file);
}

static void print_option(FILE *file, const char *name, const char *value)
{
    fprintf(file, " --%s", name);
    if (value) {
        fputc(' ', file);
        print_word(file, value);
    }
}

void adcgs_sweep_print_line(FILE *file, const char *program, const adcgs_sweep_request *request, const char *run)
{
    const adcgs_sweep_words *const w = &request->words;
    print_word(file, program);
    for (int i = 0; i < w->n; i++)
        print_option(file, w->option[i].name, w->option[i].value);
    print_option(file, "output", request->sweep.directory);
    if (run)
        print_option(file, "run", run);
    fputs(request->sweep.scene[0] == '-' ? " -- " : " ", file);
    print_word(file, request->sweep.scene);
}

/* ---- Command line ---- */

/** Values that are parsed further before the sweep uses them. */
typedef struct given {
    lists l;
    int dataset, has_dataset, has_jobs;
    const char *names[ADCGS_SETTING_NAMES + 1];
} given;

/** Fills the table of options, with targets in these structs; returns the number of options. */
static size_t list_options(adcgs_option out[ADCGS_SWEEP_OPTIONS], adcgs_sweep_request *request, given *g)
{
    adcgs_sweep *const sweep = &request->sweep;
    const adcgs_setting *const iterations = adcgs_setting_find("iterations");
    adcgs_setting_names(g->names);
    const adcgs_option table[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &sweep->directory, 0, 0, "DIR", "folder for all results (required)", NULL, NULL},
        {"lambda", 'l', ADCGS_OPTION_STRING, &g->l.lambdas, 0, 0, "A,B,C",
         "values of the encoder's --lambda (required, except\nwith --ablation)", NULL, NULL},
        {"k", 0, ADCGS_OPTION_STRING, &g->l.ks, 0, 0, "A,B,C", "values of the encoder's --k (default: the preset's)", NULL, NULL},
        {"grid", 0, ADCGS_OPTION_STRING, &g->l.grid, 0, 0, "NAME=A,B,...",
         "a curve for each combination of values of any settings of\nthe encoder, and of preset, time-limit, segment, key,\n"
         "threads and cpu; blanks between two such lists",
         g->names, NULL},
        {"seeds", 0, ADCGS_OPTION_STRING, &g->l.seeds, 0, 0, "A,B,C",
         "seeds of each point; figures are means over them (default:\nthe encoder's seed)", NULL, NULL},
        {"yardsticks", 0, ADCGS_OPTION_STRING, &g->l.yardsticks, 0, 0, "NAME,...",
         "baselines: networks (of 32 bits; no run), uncompressed (two\n"
         "runs; by zstd and xz), gaussians (a curve and a run); all\n(default) or none",
         NULL, NULL},
        {"against", 0, ADCGS_OPTION_FILE, &sweep->against, 0, 0, "DIR,...",
         "folders of earlier sweeps of the scene to compare with, of\nany version or settings", NULL, NULL},
        {"add", 0, ADCGS_OPTION_STRING, &sweep->tables, 0, 0, "NAME=FILE,...",
         "tables of other methods to plot, CSV with columns bytes and\npsnr, and optionally ssim, dynamic_psnr, cpu_seconds,\n"
         "frames_per_second, source",
         NULL, NULL},
        {"ablation", 0, ADCGS_OPTION_FLAG, &sweep->ablation, 0, 0, NULL,
         "train the stages of the method one after another, and\n5, 10 and 15 primitives per anchor (nine runs)", NULL, NULL},
        {"preset", 'p', ADCGS_OPTION_STRING, &sweep->preset, 0, 0, "NAME", "preset of the encoder (default: its own)",
         adcgs_train_presets, NULL},
        {"fixed", 0, ADCGS_OPTION_FLAG, &sweep->fixed, 0, 0, NULL, "model sizes of the preset, as adcgs-enc --fixed", NULL, NULL},
        {"set", 0, ADCGS_OPTION_STRING, &sweep->set, 0, 0, "NAME=VALUE,...", "settings of the encoder", g->names, NULL},
        {"dataset", 0, ADCGS_OPTION_CHOICE, &g->dataset, 0, 0, "KIND", "kind of the scene, as for adcgs-enc", adcgs_dataset_names,
         &g->has_dataset},
        {"frames", 0, ADCGS_OPTION_STRING, &sweep->frames, 0, 0, "A:B:STEP", "frames of the scene, as for adcgs-enc", NULL, NULL},
        {"iterations", 'n', ADCGS_OPTION_INT, &sweep->iterations, iterations->min, iterations->max, "N",
         "iterations of training (default: the preset's)", NULL, NULL},
        {"jobs", 'j', ADCGS_OPTION_INT, &request->jobs, 1, 64, "N", "number of concurrent encoders (default: 1)", NULL,
         &g->has_jobs},
        {"threads", 'T', ADCGS_OPTION_INT, &sweep->threads, 0, 256, "N", "threads of each encoder (default: one per CPU)", NULL,
         NULL},
        {.letter = 't', .kind = ADCGS_OPTION_FORMER, .value = "threads"},
        {"resume", 0, ADCGS_OPTION_FLAG, &sweep->resume, 0, 0, NULL,
         "keep the finished runs of an earlier sweep with the same\nsettings, and continue the others", NULL, NULL},
        {"list", 0, ADCGS_OPTION_FLAG, &request->list, 0, 0, NULL,
         "run nothing: print a command for each run, one a line, for\nany number of machines; with --resume only those that are\n"
         "not finished",
         NULL, NULL},
        {"run", 0, ADCGS_OPTION_STRING, &request->run, 0, 0, "NAME",
         "name of the only run to execute; a begun run continues, a\nfinished run stays", NULL, NULL},
        {"collect", 0, ADCGS_OPTION_FILE, &request->collect, 0, 0, "DIR",
         "make tables and charts of the finished runs of --list in\n"
         "this folder, and name the others; no other options",
         NULL, NULL},
    };
    memcpy(out, table, sizeof table);
    return ADCGS_COUNTOF(table);
}

int adcgs_sweep_parse(adcgs_cli *cli, adcgs_sweep_request *request, int argc, char **argv)
{
    static const adcgs_option_rule rules[] = {
        {"collect", ADCGS_OPTION_GOES_WITH, NULL}, /* its folder stores the others */
        {"against,add", ADCGS_OPTION_NEEDS, "lambda"},
        {"list,run", ADCGS_OPTION_APART, NULL},
        {"jobs", ADCGS_OPTION_EXCLUDES, "list,run"},
    };
    given g = {.dataset = 0};
    adcgs_option options[ADCGS_SWEEP_OPTIONS];
    int first = 0;
    request->jobs = 1;
    cli->options = options;
    cli->n_options = list_options(options, request, &g);
    cli->rules = rules;
    cli->n_rules = ADCGS_COUNTOF(rules);
    const int leave = adcgs_cli_parse(cli, argc, argv, &first);
    take_words(&request->words, options, cli->n_options);
    cli->n_options = 0; /* options is local to this function */
    if (leave >= 0)
        return leave;
    if (request->collect && argc > first)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--collect excludes operands: its folder stores them");
    if (request->collect)
        return -1;
    if (argc == first)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "expected %s; try '%s --help'", cli->operands, cli->program);
    request->sweep.scene = argv[first];
    request->sweep.dataset = g.has_dataset ? adcgs_dataset_names[g.dataset] : NULL;
    int bad = check_options(cli, request, &g.l);
    if (bad < 0)
        bad = parse_lists(cli, &g.l, &request->sweep);
    return bad < 0 ? check_settings(cli, &request->sweep) : bad;
}
