/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A random stream of three segments and its bytes, for tests of the public decoder. Included after cmocka's needs. */
#ifndef ADCGS_TESTS_DECODER_FIXTURE_H
#define ADCGS_TESTS_DECODER_FIXTURE_H

#include "stream_fixture.h"

#include <adcgs/adcgs.h>

static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_params params;
    uint64_t seed = 11; /* no segment crossfades into the next */
    adcgs_random_params(&params, 1, &seed);
    params.k = 4;
    params.n_fg = 4;
    params.chunks = 2;
    params.spans = 0; /* primitives without a lifetime are always present: opacities show the masks */
    if (adcgs_random_stream(&f->stream, &params, 3, 90, 5, &seed, NULL) != ADCGS_OK)
        return -1;
    for (uint32_t i = 0; i < f->stream.n_segments; i++)
        adcgs_random_one_tier(&f->stream.segments[i]);
    f->stream.colour_space = 1;
    f->stream.axes = 2;
    f->stream.units = 1;
    f->stream.scene_scale = 2.5;
    f->stream.scene_origin[1] = 0.75;
    f->stream.background[0] = 0.5f;
    return adcgs_stream_write(&f->stream, &f->bytes, NULL) == ADCGS_OK ? 0 : -1;
}

/** The anchors of all segments; the number of predicted segments' anchors is random. */
static inline uint32_t fixture_anchors(const fixture *f)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < f->stream.n_segments; i++)
        n += f->stream.segments[i].n;
    return n;
}

static adcgs_decoder *open_with(const fixture *f, const adcgs_config *config)
{
    adcgs_decoder *d = NULL;
    adcgs_error error = {ADCGS_OK, ""};
    if (adcgs_open_memory(&d, f->bytes.data, f->bytes.size, config, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_non_null(d);
    return d;
}

/** A camera before the scene, which fills about half of the image. */
#define FIXTURE_WIDTH 61
#define FIXTURE_HEIGHT 47
static const adcgs_camera fixture_camera = {.width = FIXTURE_WIDTH,
                                            .height = FIXTURE_HEIGHT,
                                            .fx = 60,
                                            .fy = 60,
                                            .cx = 30,
                                            .cy = 23,
                                            .near_plane = 0.1,
                                            .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0.75, 0, 0, 1, -9}};
#define FIXTURE_PIXELS ((size_t)FIXTURE_WIDTH * FIXTURE_HEIGHT)

#endif
