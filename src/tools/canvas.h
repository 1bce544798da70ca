/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What adcgs-dec makes of a rendered frame before it goes out: alpha and depth with it, another stream beside it. */
#ifndef ADCGS_TOOLS_CANVAS_H
#define ADCGS_TOOLS_CANVAS_H

#include "camera/path.h"
#include "io/sink.h"
#include "tools/mosaic.h"

typedef struct adcgs_canvas {
    adcgs_frame frame;        /**< to render into */
    adcgs_frame shown;        /**< what goes out, once adcgs_canvas_finish() has been called */
    adcgs_sink_extras extras; /**< what goes with it */
    float *alpha, *depth;     /**< of the size of the frame, or NULL */
    float background[3];
    adcgs_frame second;       /**< of the stream beside; without pixels if there is none */
    adcgs_mosaic mosaic;
} adcgs_canvas;

/** Frames of this size; beside nonzero: room for a second one next to each. adcgs_canvas_clear() afterwards. */
adcgs_status adcgs_canvas_init(adcgs_canvas *canvas, const int size[2], const adcgs_info *info, int alpha, int depth, int beside,
                               adcgs_error *error);
void adcgs_canvas_clear(adcgs_canvas *canvas);
/** After canvas->frame has been rendered: the rest. It may change the frame's values. beside may be NULL. */
adcgs_status adcgs_canvas_finish(adcgs_canvas *canvas, adcgs_decoder *decoder, adcgs_decoder *beside, const adcgs_shot *shot,
                                 adcgs_error *error);

#endif
