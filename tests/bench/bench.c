/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Speed: the machine's ceilings first, then kernels, stages, frames, iterations and playing beside them. See HACKING.md.
 *
 *     make tests/bench/adcgs-bench && tests/bench/adcgs-bench --csv speed.csv
 */
#define _POSIX_C_SOURCE 200809L

#include "ceilings.h"
#include "parts.h"


#include <stdlib.h>
#include <unistd.h>

static const char usage[] =
    "Usage: adcgs-bench [options]\n"
    "Measures this build on this machine. Things that are compared take turns, so a busy\n"
    "machine spoils times, but hardly ratios.\n\n"
    "  -o FILE     also write a table of all figures here (CSV)\n"
    "  -g GROUP    only groups whose name begins so: frame, stages, loss, exactness,\n"
    "              levels, dense, integer, decode, trainer, train, play\n"
    "  -c LEVEL    kernels: auto, scalar, avx2, avx512 (default auto)\n"
    "  -t N        threads at most (default: one per CPU)\n"
    "  -r N        turns of each thing, 3 to 101 (default 15)\n"
    "  -s FOLDER   where the training's scene is made, or was (default bench-scenes)\n"
    "  -q          a part of it: one size, one number of splats\n"
    "  -h          print this text and exit\n";

typedef struct settings {
    bench b;
    const char *scenes;
    int quick;
} settings;

static int refuse(const char *what)
{
    fprintf(stderr, "adcgs-bench: %s; see adcgs-bench -h\n", what);
    return 2;
}

/** 0, or the exit status plus one. */
static int parse(settings *s, int argc, char **argv)
{
    adcgs_error error = { .status = ADCGS_OK };
    adcgs_cpu_level asked = ADCGS_CPU_AUTO;
    for (int option; (option = getopt(argc, argv, "o:g:c:t:r:s:qh")) != -1;) {
        switch (option) {
        case 'o':
            s->b.csv = fopen(optarg, "w");
            if (!s->b.csv)
                return 1 + refuse("cannot write the table");
            break;
        case 'g': s->b.only = optarg; break;
        case 'c':
            if (adcgs_cpu_parse(optarg, &asked))
                return 1 + refuse("unknown level");
            break;
        case 't': s->b.threads = atoi(optarg); break;
        case 'r': s->b.rounds = atoi(optarg); break;
        case 's': s->scenes = optarg; break;
        case 'q': s->quick = 1; break;
        case 'h': fputs(usage, stdout); return 1;
        default: return 1 + refuse("unknown option");
        }
    }
    if (optind < argc || s->b.threads < 1 || s->b.threads > 256 || s->b.rounds < 3 || s->b.rounds > 101)
        return 1 + refuse("bad number or operand");
    bench_check(adcgs_cpu_resolve(asked, &s->b.level, &error), &error);
    return 0;
}

static void measure_all(const settings *s)
{
    static const int sizes[][2] = { { 400, 400 }, { 200, 200 }, { 800, 800 }, { 1352, 1014 } };
    static const uint32_t splats[] = { 20000, 5000, 50000, 100000 }, anchors[] = { 2000, 500, 5000, 10000 };
    const bench *b = &s->b;
    bench_header(b);
    bench_kernels(b);
    bench_levels(b);
    for (size_t i = 0; i < (s->quick ? 1 : ADCGS_COUNTOF(sizes)); i++)
        for (size_t j = 0; j < (s->quick ? 1 : ADCGS_COUNTOF(splats)); j++)
            bench_frames(b, sizes[i][0], sizes[i][1], splats[j]);
    for (size_t j = 0; j < (s->quick ? 1 : ADCGS_COUNTOF(anchors)); j++)
        bench_training(b, s->scenes, 400, 400, anchors[j], "fast");
    bench_training(b, s->scenes, 400, 400, 2000, "paper");
    if (!s->quick)
        for (size_t j = 0; j < ADCGS_COUNTOF(anchors); j += 3)
            bench_training(b, s->scenes, 1352, 1014, anchors[j], "paper");
}

int main(int argc, char **argv)
{
    settings s = { .b = { .rounds = 15, .turn = 2e-3, .threads = (int)sysconf(_SC_NPROCESSORS_ONLN) }, .scenes = "bench-scenes" };
    const int status = parse(&s, argc, argv);
    if (status)
        return status - 1;
    bench_find_ceilings(&s.b);
    measure_all(&s);
    if (s.b.csv && fclose(s.b.csv) != 0)
        return refuse("the table could not be written") - 1;
    return 0;
}
