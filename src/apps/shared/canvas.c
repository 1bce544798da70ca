/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Turns a rendered frame of adcgs-dec into its output. */
#include "config.h"

#include "apps/shared/canvas.h"

#include <adcgs/decoder.h>

#include <stdlib.h>

static adcgs_status allocate(float **floats, const int size[2], size_t each, adcgs_error *error)
{
    *floats = malloc((size_t)size[0] * (size_t)size[1] * each * sizeof **floats);
    return *floats ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a frame");
}

adcgs_status adcgs_canvas_init(adcgs_canvas *canvas, const int size[2], const adcgs_info *info, int alpha, int depth, int beside,
                               adcgs_error *error)
{
    *canvas = (adcgs_canvas){.frame = {size[0], size[1], NULL}, .second = {size[0], size[1], NULL}};
    memcpy(canvas->background, info->background, sizeof canvas->background);
    ADCGS_TRY(allocate(&canvas->frame.rgb, size, 3, error));
    canvas->shown = canvas->frame;
    if (alpha)
        ADCGS_TRY(allocate(&canvas->alpha, size, 1, error));
    if (depth)
        ADCGS_TRY(allocate(&canvas->depth, size, 1, error));
    if (beside) {
        ADCGS_TRY(allocate(&canvas->second.rgb, size, 3, error));
        ADCGS_TRY(adcgs_mosaic_init(&canvas->mosaic, size[0], size[1], 2, 1, "--beside", error));
        canvas->shown = (adcgs_frame){canvas->mosaic.image.width, canvas->mosaic.image.height, canvas->mosaic.image.data};
    }
    return ADCGS_OK;
}

void adcgs_canvas_clear(adcgs_canvas *canvas)
{
    free(canvas->frame.rgb);
    free(canvas->second.rgb);
    free(canvas->alpha);
    free(canvas->depth);
    adcgs_mosaic_clear(&canvas->mosaic);
    *canvas = (adcgs_canvas){0};
}

/** Subtracts the background that shows through the colours. */
static void remove_background(adcgs_canvas *canvas)
{
    const size_t n = (size_t)canvas->frame.width * (size_t)canvas->frame.height;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++)
            canvas->frame.rgb[3 * i + c] -= (1.0f - canvas->alpha[i]) * canvas->background[c];
}

adcgs_status adcgs_canvas_finish(adcgs_canvas *canvas, adcgs_decoder *decoder, adcgs_decoder *beside,
                                 const adcgs_camera_frame *frame, adcgs_error *error)
{
    canvas->extras = (adcgs_sink_extras){canvas->alpha, canvas->depth, &frame->camera, frame->time};
    if (canvas->alpha || canvas->depth)
        ADCGS_TRY(adcgs_camera_path_rendered(&frame->camera,
                                             adcgs_render_depth(decoder, &frame->camera, frame->time, canvas->depth,
                                                                canvas->alpha, error),
                                             error));
    if (canvas->alpha)
        remove_background(canvas);
    if (beside) {
        ADCGS_TRY(adcgs_camera_path_rendered(&frame->camera,
                                             adcgs_render(beside, &frame->camera, frame->time, &canvas->second, error), error));
        canvas->extras = (adcgs_sink_extras){0}; /* two images have no common camera */
        adcgs_mosaic_place(&canvas->mosaic, 0, 0, (adcgs_samples){canvas->frame.rgb, 3, 1});
        adcgs_mosaic_place(&canvas->mosaic, 1, 0, (adcgs_samples){canvas->second.rgb, 3, 1});
    }
    return ADCGS_OK;
}
