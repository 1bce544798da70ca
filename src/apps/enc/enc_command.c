/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The command line of adcgs-enc: its table of options, and the rules for options that go together. */
#include "config.h"

#include "apps/enc/enc_command.h"

#include "apps/enc/enc_configure.h"
#include "base/cpu_detect.h"
#include "media/dynamic/dynamic_splats.h"
#include "media/kind.h"
#include "scene/layouts/open.h"
#include "session/enc_plan.h"
#include "train/settings.h"
#include "train/stage_table.h"

/* ---- Options ---- */

/** Options for the result: its file, its size or quality, the size of the model. */
static void add_result_options(adcgs_option_table *out, adcgs_enc_options *o)
{
    const adcgs_setting *const lambda = adcgs_setting_find("lambda"), *const iterations = adcgs_setting_find("iterations");
    const adcgs_setting *const scale = adcgs_setting_find("scale"), *const k = adcgs_setting_find("k");
    const adcgs_setting *const anchors = adcgs_setting_find("max_anchors");
    const adcgs_option table[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &o->output, 0, 0, "FILE", "stream to write (required, except with --beginning)", NULL,
         NULL},
        {"preset", 'p', ADCGS_OPTION_STRING, &o->preset, 0, 0, "NAME", "draft, fast, medium, slow or paper (default fast)",
         adcgs_train_presets, NULL},
        {"lambda", 'l', ADCGS_OPTION_REAL, &o->lambda, lambda->min, lambda->max, "X",
         "loss per mebibyte of features and networks; a larger value\nmakes smaller files (default: the preset's, times the\n"
         "images' contrast over 0.22)",
         NULL, &o->has_lambda},
        {"size", 'S', ADCGS_OPTION_SIZE, &o->size, ADCGS_TARGET_SIZE_MIN, ADCGS_TARGET_SIZE_MAX, "BYTES",
         "maximum file size, reached within 3 % (150k, 1.5M, 2MiB);\nreplaces --lambda", NULL, &o->has_size},
        {.letter = 's', .kind = ADCGS_OPTION_FORMER, .value = "size"},
        {"psnr", 0, ADCGS_OPTION_REAL, &o->psnr, ADCGS_TARGET_PSNR_MIN, ADCGS_TARGET_PSNR_MAX, "DB",
         "target mean PSNR of the training views, decoded from the\nfile, dB, +/- 0.1; the file is as small as it allows; test\n"
         "views are never used",
         NULL, &o->has_psnr},
        {"iterations", 'n', ADCGS_OPTION_INT, &o->iterations, iterations->min, iterations->max, "N",
         "iterations of the run (default: the preset's)", NULL, &o->has_iterations},
        {"scale", 0, ADCGS_OPTION_INT, &o->scale, scale->min, scale->max, "S",
         "divisor of the image size, an integer (default: 1, more for\nimages of over 1600 pixels)", NULL, &o->has_scale},
        {"k", 0, ADCGS_OPTION_INT, &o->k, k->min, k->max, "N", "primitives per anchor, 1 to 16 (default: the preset's)", NULL,
         &o->has_k},
        {"max-anchors", 0, ADCGS_OPTION_INT, &o->max_anchors, anchors->min, anchors->max, "N",
         "budget of anchors (default: from the amount of detail in\nthe images)", NULL, &o->has_max_anchors},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the scene: its kind, its frames and its initial points. */
static void add_scene_options(adcgs_option_table *out, adcgs_enc_options *o)
{
    const adcgs_option table[] = {
        {"dataset", 0, ADCGS_OPTION_CHOICE, &o->dataset, 0, 0, "KIND",
         "kind of the scene, instead of detecting it by its files:\nauto, transforms, hypernerf, llff, colmap, adcgs, splats\n"
         "or panoptic",
         adcgs_dataset_names, NULL},
        {"frames", 0, ADCGS_OPTION_STRING, &o->frames, 0, 0, "A:B:STEP",
         "frames A, A + STEP, ... below B of videos, or timestamps of\nimages, counted so; A, B or :STEP may be left out", NULL,
         NULL},
        {"fps", 0, ADCGS_OPTION_STRING, &o->fps, 0, 0, "N[/D]",
         "rate of the selected frames, per second (default: the\nscene's, else 30)", NULL, NULL},
        {"splat-frames", 0, ADCGS_OPTION_INT, &o->splat_frames, 1, ADCGS_DYNAMIC_FRAMES_MAX, "N",
         "frames of splats over time whose file has times from 0 to 1\n(default: the file's, else 50)", NULL,
         &o->has_splat_frames},
        {"partial", 0, ADCGS_OPTION_FLAG, &o->is_partial, 0, 0, NULL,
         "accept splats over time that cannot be read completely, as\nSpacetimeGaussians' full model without its network", NULL,
         NULL},
        {"points", 0, ADCGS_OPTION_FILE, &o->points, 0, 0, "FILE",
         "initial points (PLY, NPY, Draco or splats) instead of the\nscene's or random ones", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for segments: cut, planned or live. */
static void add_segment_options(adcgs_option_table *out, adcgs_enc_options *o)
{
    const adcgs_option table[] = {
        {"segment", 0, ADCGS_OPTION_SECONDS, &o->segment, 1e-3, 1e6, "S",
         "length of segments, seconds, cut at the nearest timestamp;\n"
         "each is trained from the previous one, in a run of its own;\n"
         "with --plan: number of the only segment to train",
         NULL, &o->has_segment},
        {"plan", 0, ADCGS_OPTION_FILE, &o->plan, 0, 0, "FILE",
         "plan of the segments, with all settings: written, or read\nwith --segment 1, 2, ..., which trains one part anywhere;\n"
         "adcgs-join joins the parts",
         NULL, NULL},
        {"cut", 0, ADCGS_OPTION_SECONDS, &o->cut, 1e-3, 1e6, "S", "with --plan: length of segments, seconds (default 2)", NULL,
         &o->has_cut},
        {"key", 0, ADCGS_OPTION_SECONDS, &o->key, 0, 1e6, "S",
         "with --segment: longest interval of key segments, which need\n"
         "no other and where playback can begin, seconds (default 10)",
         NULL, &o->has_key},
        {"fade", 0, ADCGS_OPTION_SECONDS, &o->fade, 0, 1e6, "S",
         "with --segment: crossfade from the previous segment, seconds,\n"
         "at most a quarter of a segment (default 0.2; 0: none)",
         NULL, &o->has_fade},
        {"or-whole", 0, ADCGS_OPTION_FLAG, &o->or_whole, 0, 0, NULL,
         "with --segment: also train one segment of the whole time,\nand write that if it is neither larger nor worse", NULL,
         NULL},
        {"live", 0, ADCGS_OPTION_FLAG, &o->live, 0, 0, NULL,
         "train footage while it arrives: SCENE is a scene file, or a\n"
         "folder with scene.json; segments, of 2 s or as --segment says,\n"
         "are written when done; -o - writes to standard output; a\ncamera's video may be -, standard input",
         NULL, NULL},
        {"delay", 0, ADCGS_OPTION_SECONDS, &o->delay, 1e-3, 1e6, "S",
         "with --live: maximum time from filming to writing, seconds;\neffort falls if needed (default: no limit)", NULL,
         &o->has_delay},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the method: its parts and its settings. */
static void add_method_options(adcgs_option_table *out, adcgs_enc_options *o, const char *const *names)
{
    const adcgs_option table[] = {
        {"without", 0, ADCGS_OPTION_STRING, &o->without, 0, 0, "PART,...",
         "parts to leave out: coarse, fine, deformation (both), rate,\n"
         "densification, anchors, removal or weight_steps",
         NULL, NULL},
        {"uncompressed", 0, ADCGS_OPTION_FILE, &o->uncompressed, 0, 0, "FILE",
         "file for the model as plain binary32 numbers, trained\nwithout rate and rounding; the stream is then the finest", NULL,
         NULL},
        {"fixed", 0, ADCGS_OPTION_FLAG, &o->fixed, 0, 0, NULL, "model size from the preset alone, not from the scene", NULL,
         NULL},
        {"no-progression", 0, ADCGS_OPTION_FLAG, &o->no_progression, 0, 0, NULL,
         "all anchors at once, instead of tiers that each add detail\nto the previous ones; a few percent smaller", NULL, NULL},
        {"set", 0, ADCGS_OPTION_STRING, &o->set, 0, 0, "NAME=VALUE,...",
         "changes of the preset's settings; 'list' shows them all", names, NULL},
        {"schedule", 0, ADCGS_OPTION_FLAG, &o->schedule, 0, 0, NULL,
         "print the stages of the run by these settings, and exit; a\nscene may change some of them", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the run: its end, its seed, and the files of its state. */
static void add_run_options(adcgs_option_table *out, adcgs_enc_options *o)
{
    const adcgs_setting *const seed = adcgs_setting_find("seed");
    const adcgs_option table[] = {
        {"time-limit", 0, ADCGS_OPTION_SECONDS, &o->time_limit, 0, ADCGS_TIME_LIMIT_MAX, "S",
         "time until training ends, seconds, load time included; the\n"
         "result then depends on the machine's speed (default: no limit)",
         NULL, NULL},
        {"seed", 0, ADCGS_OPTION_SIZE, &o->seed, seed->min, seed->max, "N", "seed of every random choice (default 1)", NULL,
         &o->has_seed},
        {"checkpoint", 0, ADCGS_OPTION_FILE, &o->checkpoint, 0, 0, "FILE",
         "file for the state of the run, saved every minute and when\n"
         "interrupted (default then: the output's name.checkpoint)",
         NULL, NULL},
        {"checkpoint-every", 0, ADCGS_OPTION_SECONDS, &o->checkpoint_every, 0, 1e6, "S",
         "interval of such saves, seconds (default 60)", NULL, NULL},
        {"resume", 0, ADCGS_OPTION_FILE, &o->resume, 0, 0, "FILE",
         "state to continue from; same scene, same options (with --live:\nthe output that a run has left)", NULL, NULL},
        {"finish", 0, ADCGS_OPTION_FILE, &o->finish, 0, 0, "FILE",
         "state to make a stream of without more training; same scene,\nsame options", NULL, NULL},
        {"beginning", 0, ADCGS_OPTION_FILE, &o->beginning, 0, 0, "FILE",
         "file for the state up to which lambda has no effect; the run\nends there; runs with any lambda can --resume it", NULL,
         NULL},
        {"log", 0, ADCGS_OPTION_FILE, &o->log, 0, 0, "FILE",
         "progress as JSON lines; appended with --resume, and by a\nplan's segments", NULL, NULL},
        {"preview", 0, ADCGS_OPTION_FILE, &o->preview, 0, 0, "FILE",
         "image (PNG, JPEG, ...) of a view as filmed and as rendered,\nupdated every 30 seconds", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the machine, and for messages. */
static void add_machine_options(adcgs_option_table *out, adcgs_enc_options *o)
{
    const adcgs_option table[] = {
        {"memory", 0, ADCGS_OPTION_SIZE, &o->memory, 1, 1e15, "BYTES",
         "maximum memory of images, bytes (2G); the others are kept in\n"
         "a file in TMPDIR (default: half of the machine's); no effect\non the result",
         NULL, NULL},
        {"threads", 'T', ADCGS_OPTION_INT, &o->threads, 0, 256, "N", "threads (default: one per CPU); no effect on the result",
         NULL, NULL},
        {.letter = 't', .kind = ADCGS_OPTION_FORMER, .value = "threads"},
        {"cpu", 0, ADCGS_OPTION_CHOICE, &o->cpu, 0, 0, "LEVEL", "kernels: auto, scalar, avx2, avx512 (default auto)",
         adcgs_cpu_names, NULL},
        {"bf16", 0, ADCGS_OPTION_FLAG, &o->bf16, 0, 0, NULL,
         "train the networks of the rendered values in bf16, which is\nfaster; needs a CPU with AVX512-BF16", NULL, NULL},
        {"json", 'J', ADCGS_OPTION_FLAG, &o->json, 0, 0, NULL, "print the result as one JSON object on stdout", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Fills the table of options, in the order of the help, with targets in o. names: of settings. */
static void list_options(adcgs_option_table *out, adcgs_enc_options *o, const char *const *names)
{
    add_result_options(out, o);
    add_scene_options(out, o);
    add_segment_options(out, o);
    add_method_options(out, o, names);
    add_run_options(out, o);
    add_machine_options(out, o);
}

/* ---- Rules ---- */

static const adcgs_option_rule option_rules[] = {
    {"cut", ADCGS_OPTION_NEEDS, "plan"},
    {"output,beginning", ADCGS_OPTION_APART, NULL},
    {"lambda,size,psnr", ADCGS_OPTION_APART, NULL},
    {"finish", ADCGS_OPTION_EXCLUDES, "resume,beginning,checkpoint,segment,live,time-limit"},
    {"live", ADCGS_OPTION_EXCLUDES,
     "size,psnr,beginning,uncompressed,time-limit,frames,fps,checkpoint,dataset,or-whole,fade,splat-frames,partial"},
    {"plan", ADCGS_OPTION_EXCLUDES, "splat-frames,partial"},
    {"delay", ADCGS_OPTION_NEEDS, "live"},
    {"key", ADCGS_OPTION_NEEDS, "segment,plan,live"},
    {"fade", ADCGS_OPTION_NEEDS, "segment,plan"},
    {"or-whole", ADCGS_OPTION_NEEDS, "segment"},
    {"segment", ADCGS_OPTION_EXCLUDES, "size,beginning,uncompressed,time-limit"},
};

/** Checks the values of options with --live. Returns like adcgs_enc_parse(). */
static int check_live(const adcgs_cli *cli, adcgs_enc_options *o)
{
    if (!o->has_segment)
        o->segment = ADCGS_ENC_LIVE_SEGMENT;
    if (o->has_delay && o->delay <= o->segment)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--delay %g: a segment of %g s is trained after its end is filmed: give a "
                               "longer delay, or a shorter --segment",
                               o->delay, o->segment);
    if (o->json && !strcmp(o->output, "-"))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--json and -o - both write to standard output");
    return -1;
}

/* ---- The whole command line ---- */

/** Reports surplus operands. Other players take a file of splats for each timestamp. */
static int report_surplus(const adcgs_cli *cli, int n, char **operands)
{
    int splats = 0;
    while (splats < n && adcgs_kind_at(operands[splats])->class == ADCGS_KIND_SPLATS)
        splats++;
    if (splats == n)
        return adcgs_cli_error(cli, ADCGS_ERR_UNSUPPORTED,
                               "%.100s and %d more files of splats: give the folder of a sequence, or one file", *operands,
                               n - 1);
    return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: one operand too many; try '%s --help'", operands[1], cli->program);
}

static int list_settings(const adcgs_cli *cli, const adcgs_enc_options *o)
{
    adcgs_train_config config;
    adcgs_error error;
    if (adcgs_train_preset(&config, o->preset, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_train_list(&config, stdout);
    return adcgs_cli_leave(cli, 0);
}

static int print_schedule(const adcgs_cli *cli, const adcgs_enc_options *o)
{
    adcgs_train_config config;
    adcgs_error error;
    if (adcgs_enc_configure(&config, o, ADCGS_CPU_SCALAR, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_stage_list(&config, stdout);
    return adcgs_cli_leave(cli, 0);
}

int adcgs_enc_parse(adcgs_cli *cli, adcgs_enc_options *o, int argc, char **argv)
{
    const char *names[ADCGS_SETTING_NAMES + 1];
    adcgs_option_table options = {.n = 0};
    adcgs_setting_names(names);
    cli->options = options.rows;
    list_options(&options, o, names);
    cli->n_options = options.n;
    cli->rules = option_rules;
    cli->n_rules = ADCGS_COUNTOF(option_rules);
    cli->quiet = &o->quiet;
    const adcgs_enc_options before = *o;
    int first, code = adcgs_cli_parse(cli, argc, argv, &first);
    if (code < 0 && o->plan)
        code = adcgs_enc_plan_check(cli, o, &before);
    cli->n_options = 0; /* options is local to this function */
    if (code >= 0)
        return code;
    if (o->set && !strcmp(o->set, "list"))
        return list_settings(cli, o);
    if (o->schedule)
        return print_schedule(cli, o);
    if (first >= argc)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "one operand expected: SCENE");
    if (first + 1 < argc)
        return report_surplus(cli, argc - first, argv + first);
    o->scene = argv[first];
    if (o->plan) /* adcgs_enc_plan_check() has checked the options */
        return -1;
    if (!o->output && !o->beginning)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "no output: give -o FILE");
    return o->live ? check_live(cli, o) : -1;
}
