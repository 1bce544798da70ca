/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-demo-grid: one picture to look at: some views of a scene in columns,
 * truth above, decoded in the middle, their difference below. Not installed.
 */
#include "io/image.h"
#include "metric/evaluate.h"
#include "tools/cli.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <stdlib.h>

#define GAP 4
/* The difference is shown around grey, this many times as strong. */
#define GAIN 4.0f

typedef struct grid {
    int columns, total, seen, placed;
    adcgs_image image;
} grid;

enum { ROW_TRUTH, ROW_DECODED, ROW_DIFFERENCE, ROWS };

static adcgs_status allocate(grid *g, int width, int height, adcgs_error *error)
{
    g->image = (adcgs_image){.width = g->columns * (width + GAP) - GAP, .height = ROWS * (height + GAP) - GAP, .channels = 3};
    const size_t n = 3 * (size_t)g->image.width * (size_t)g->image.height;
    g->image.data = malloc(n * sizeof *g->image.data);
    if (!g->image.data)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    for (size_t i = 0; i < n; i++)
        g->image.data[i] = 1.0f;
    return ADCGS_OK;
}

static void place(grid *g, int row, const adcgs_view_score *s)
{
    const size_t plane = (size_t)s->width * (size_t)s->height;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            const size_t from = (size_t)y * (size_t)s->width + (size_t)x;
            const size_t line = (size_t)(row * (s->height + GAP) + y), column = (size_t)(g->placed * (s->width + GAP) + x);
            float *const to = g->image.data + 3 * (line * (size_t)g->image.width + column);
            for (size_t c = 0; c < 3; c++) {
                const float truth = s->truth[c * plane + from], decoded = s->decoded[c * plane + from];
                const float shown = row == ROW_TRUTH ? truth : row == ROW_DECODED ? decoded : 0.5f + GAIN * (decoded - truth);
                to[c] = fminf(fmaxf(shown, 0.0f), 1.0f);
            }
        }
}

/* Views are taken evenly from the split; those of another size than the first are left out. */
static adcgs_status take(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    grid *const g = user;
    const int wanted = g->placed < g->columns && (int64_t)g->seen * g->columns >= (int64_t)g->placed * g->total;
    g->seen++;
    if (!wanted)
        return ADCGS_OK;
    if (!g->image.data)
        ADCGS_TRY(allocate(g, score->width, score->height, error));
    if (g->columns * (score->width + GAP) - GAP != g->image.width || ROWS * (score->height + GAP) - GAP != g->image.height)
        return ADCGS_OK;
    for (int row = 0; row < ROWS; row++)
        place(g, row, score);
    g->placed++;
    return ADCGS_OK;
}

static adcgs_status draw(const char *stream, const char *folder, const char *output, int columns, adcgs_error *error)
{
    adcgs_config config;
    adcgs_decoder *decoder = NULL;
    adcgs_scene *scene = NULL;
    adcgs_info info;
    adcgs_evaluation evaluation;
    adcgs_config_init(&config);
    ADCGS_TRY(adcgs_open_file(&decoder, stream, &config, error));
    adcgs_status status = adcgs_get_info(decoder, &info);
    adcgs_scene_options options = {.has_background = 1, .frame_rate = info.frame_rate};
    memcpy(options.background, info.background, sizeof options.background);
    if (status == ADCGS_OK)
        status = adcgs_scene_open(&scene, folder, &options, error);
    grid g = {.columns = columns};
    if (status == ADCGS_OK) {
        g.total = (int)scene->n_views[ADCGS_SPLIT_TEST];
        g.columns = ADCGS_MIN(columns, ADCGS_MAX(g.total, 1));
        status = adcgs_evaluate(&evaluation, decoder, scene, ADCGS_SPLIT_TEST, 0, take, &g, error);
    }
    if (status == ADCGS_OK)
        status = adcgs_image_write(&g.image, output, 0, error);
    free(g.image.data);
    adcgs_scene_free(&scene);
    adcgs_close(&decoder);
    return status;
}

int main(int argc, char **argv)
{
    const char *output = "grid.png";
    int columns = 5, first = 0;
    const adcgs_option options[] = {
        {.name = "output", .letter = 'o', .kind = ADCGS_OPTION_STRING, .target = &output, .value = "FILE",
         .help = "picture to write (default: grid.png)"},
        {.name = "columns", .kind = ADCGS_OPTION_INT, .target = &columns, .min = 1, .max = 64, .value = "N",
         .help = "number of test views (default: 5)"},
    };
    const adcgs_cli cli = {.program = "adcgs-demo-grid", .operands = "FILE SCENE",
                           .summary = "Lay out test views: truth, decoded, and four times their difference.", .options = options,
                           .n_options = ADCGS_COUNTOF(options), .min_operands = 2, .max_operands = 2};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    adcgs_error error = {ADCGS_OK, ""};
    const adcgs_status status = draw(argv[first], argv[first + 1], output, columns, &error);
    return status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
