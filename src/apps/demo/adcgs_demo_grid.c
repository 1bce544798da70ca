/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-demo-grid: one image of some views of a scene in columns: ground truth above, decoded view in the middle, difference
 * below. Not installed.
 */
#include "cli/cli.h"
#include "media/image/mosaic.h"
#include "metric/evaluate.h"
#include "scene/layouts/open.h"

#include <adcgs/adcgs.h>

typedef struct grid {
    int columns, total, seen, placed;
    const char *output;
    adcgs_mosaic mosaic;
} grid;

enum { ROW_TRUTH, ROW_DECODED, ROW_DIFFERENCE, ROWS };

/* Takes views evenly from the split, and skips those of another size than the first. */
static adcgs_status place_view(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    grid *const g = user;
    const int wanted = g->placed < g->columns && (int64_t)g->seen * g->columns >= (int64_t)g->placed * g->total;
    const size_t plane = (size_t)score->width * (size_t)score->height;
    const adcgs_samples truth = {score->truth, 1, plane}, decoded = {score->decoded, 1, plane};
    g->seen++;
    if (!wanted)
        return ADCGS_OK;
    if (!g->mosaic.image.data)
        ADCGS_TRY(adcgs_mosaic_init(&g->mosaic, score->width, score->height, g->columns, ROWS, g->output, error));
    if (score->width != g->mosaic.width || score->height != g->mosaic.height)
        return ADCGS_OK;
    adcgs_mosaic_place(&g->mosaic, g->placed, ROW_TRUTH, truth);
    adcgs_mosaic_place(&g->mosaic, g->placed, ROW_DECODED, decoded);
    adcgs_mosaic_difference(&g->mosaic, g->placed, ROW_DIFFERENCE, decoded, truth);
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
    adcgs_config_init(&config, sizeof config);
    ADCGS_TRY(adcgs_open_file(&decoder, stream, &config, error));
    adcgs_status status = adcgs_get_info(decoder, &info, sizeof info, error);
    adcgs_scene_options options = {.has_background = 1, .rate = adcgs_fps_of(info.frame_rate)};
    memcpy(options.background, info.background, sizeof options.background);
    if (status == ADCGS_OK)
        status = adcgs_scene_open(&scene, folder, &options, error);
    grid g = {.columns = columns, .output = output};
    if (status == ADCGS_OK) {
        g.total = (int)scene->n_views[ADCGS_SPLIT_TEST];
        g.columns = ADCGS_MIN(columns, ADCGS_MAX(g.total, 1));
        status = adcgs_evaluate(&evaluation, decoder, scene, ADCGS_SPLIT_TEST, 0, place_view, &g, error);
    }
    if (status == ADCGS_OK)
        status = adcgs_image_write(&g.mosaic.image, output, 0, error);
    adcgs_mosaic_clear(&g.mosaic);
    adcgs_scene_free(&scene);
    adcgs_close(&decoder);
    return status;
}

int main(int argc, char **argv)
{
    const char *output = "grid.png";
    int columns = 5, first = 0;
    const adcgs_option options[] = {
        {.name = "output",
         .letter = 'o',
         .kind = ADCGS_OPTION_FILE,
         .target = &output,
         .value = "FILE",
         .help = "image to write (default: grid.png)"},
        {.name = "columns",
         .kind = ADCGS_OPTION_INT,
         .target = &columns,
         .min = 1,
         .max = 64,
         .value = "N",
         .help = "number of test views (default: 5)"},
    };
    const adcgs_cli cli = {.program = "adcgs-demo-grid",
                           .operands = "FILE SCENE",
                           .summary = "Lay out test views: truth, decoded, four times their difference.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .min_operands = 2,
                           .max_operands = 2};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    adcgs_error error = {ADCGS_OK, ""};
    const adcgs_status status = draw(argv[first], argv[first + 1], output, columns, &error);
    return status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
