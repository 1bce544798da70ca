/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Turns a rendered frame of adcgs-dec into its output: with alpha and depth, or with another stream next to it. */
#ifndef ADCGS_APPS_SHARED_CANVAS_H
#define ADCGS_APPS_SHARED_CANVAS_H

#include "camera/path.h"
#include "media/image/mosaic.h"
#include "media/sink.h"

typedef struct adcgs_canvas {
    adcgs_frame frame;        /**< render target */
    adcgs_frame shown;        /**< the output, after adcgs_canvas_finish() */
    adcgs_sink_extras extras; /**< output in addition to the colours */
    float *alpha, *depth;     /**< of the frame's size, or NULL */
    float background[3];
    adcgs_frame second; /**< of the second stream; without pixels if there is none */
    adcgs_mosaic mosaic;
} adcgs_canvas;

/** Allocates frames of this size. beside: nonzero for a second frame next to each. Call adcgs_canvas_clear() afterwards. */
adcgs_status adcgs_canvas_init(adcgs_canvas *canvas, const int size[2], const adcgs_info *info, int alpha, int depth, int beside,
                               adcgs_error *error);
void adcgs_canvas_clear(adcgs_canvas *canvas);
/** Completes the output after canvas->frame has been rendered. It may change the frame's values. beside may be NULL. */
adcgs_status adcgs_canvas_finish(adcgs_canvas *canvas, adcgs_decoder *decoder, adcgs_decoder *beside,
                                 const adcgs_camera_frame *frame, adcgs_error *error);

#endif
