/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Speed: first the machine's ceilings; then kernels, stages, frames, iterations and playing, relative to them. The guide is
 * doc/hacking/measure.md.
 *
 *     tests/bench/adcgs-bench --output speed.csv
 */
#define _POSIX_C_SOURCE 200809L

#include "bench_parts.h"
#include "ceilings.h"

#include "cli/cli.h"

#include <errno.h>
#include <unistd.h>

typedef struct settings {
    bench b;
    const char *output, *scenes;
    int cpu, quick;
} settings;

static void measure_all(const settings *s)
{
    static const int sizes[][2] = {{400, 400}, {200, 200}, {800, 800}, {1352, 1014}};
    static const uint32_t splats[] = {20000, 5000, 50000, 100000}, anchors[] = {2000, 500, 5000, 10000};
    const bench *b = &s->b;
    bench_header(b);
    bench_kernels(b);
    bench_networks(b);
    bench_levels(b);
    for (size_t i = 0; i < (s->quick ? 1 : ADCGS_COUNTOF(sizes)); i++)
        for (size_t j = 0; j < (s->quick ? 1 : ADCGS_COUNTOF(splats)); j++)
            bench_frames(b, sizes[i][0], sizes[i][1], splats[j]);
    for (size_t j = 0; j < (s->quick ? 1 : ADCGS_COUNTOF(anchors)); j++)
        bench_training(b, s->scenes, 400, 400, anchors[j], "fast");
    bench_training(b, s->scenes, 400, 400, 2000, "paper");
    if (!s->quick)
        bench_training(b, s->scenes, 1352, 1014, 2000, "fast");
}

static adcgs_status open_table(settings *s, adcgs_error *error)
{
    if (s->output && !(s->b.csv = fopen(s->output, "w")))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", s->output, strerror(errno));
    return ADCGS_OK;
}

static adcgs_status close_table(settings *s, adcgs_error *error)
{
    if (s->b.csv && fclose(s->b.csv) != 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", s->output, strerror(errno));
    return ADCGS_OK;
}

static adcgs_status check_group(const bench *b, adcgs_error *error)
{
    static const char *const groups[] = {"frame",    "stages",  "loss",   "exactness", "levels", "dense",
                                         "networks", "integer", "decode", "kernels",   "train",  "play"};
    for (size_t i = 0; i < ADCGS_COUNTOF(groups); i++)
        if (bench_wants(b, groups[i]))
            return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "--group %s: no such group; see --help", b->only);
}

int main(int argc, char **argv)
{
    settings s = {.b = {.rounds = 15, .turn = 2e-3, .threads = (int)sysconf(_SC_NPROCESSORS_ONLN)}, .scenes = "bench-scenes"};
    const adcgs_option options[] = {
        {"output", 'o', ADCGS_OPTION_STRING, &s.output, 0, 0, "FILE", "also write a table of all figures here (CSV)", NULL, NULL},
        {"group", 'g', ADCGS_OPTION_STRING, &s.b.only, 0, 0, "NAME",
         "only groups whose name begins so: frame, stages, loss, exactness,\n"
         "levels, dense, networks, integer, decode, kernels, train, play",
         NULL, NULL},
        {"cpu", 'c', ADCGS_OPTION_CHOICE, &s.cpu, 0, 0, "LEVEL", "kernels: auto, scalar, avx2, avx512 (default auto)",
         adcgs_cpu_names, NULL},
        {"threads", 'T', ADCGS_OPTION_INT, &s.b.threads, 1, 256, "N", "threads at most (default: one per CPU)", NULL, NULL},
        {"turns", 'r', ADCGS_OPTION_INT, &s.b.rounds, 3, 101, "N", "turns of each item (default 15)", NULL, NULL},
        {"scenes", 0, ADCGS_OPTION_STRING, &s.scenes, 0, 0, "DIR",
         "folder of the training scene, generated if missing (default bench-scenes)", NULL, NULL},
        {"quick", 'q', ADCGS_OPTION_FLAG, &s.quick, 0, 0, NULL, "one size, one number of splats", NULL, NULL},
    };
    const adcgs_cli cli = {.program = "adcgs-bench",
                           .operands = "",
                           .summary = "Measures this build on this machine.",
                           .details = "Compared items take turns, so other load distorts times, but hardly ratios.\n",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options)};
    adcgs_error error = {.status = ADCGS_OK};
    int first;
    const int left = adcgs_cli_parse(&cli, argc, argv, &first);
    if (left >= 0)
        return left;
    if (check_group(&s.b, &error) != ADCGS_OK || adcgs_cpu_resolve((adcgs_cpu_level)s.cpu, &s.b.level, &error) != ADCGS_OK ||
        open_table(&s, &error) != ADCGS_OK)
        return adcgs_cli_fail(&cli, &error);
    bench_find_ceilings(&s.b);
    measure_all(&s);
    return close_table(&s, &error) == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
