/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted footage for live encoding: Y4M from a file that grows in two steps. The first byte gives the size of the first step.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "scene/live/live_camera.h"

#include <math.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/live", "tests/fuzz/regressions/live", NULL};

enum { FRAMES_MOST = 4096, STRETCHES = 4 };

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status == ADCGS_OK || (error->status == status && error->text[0] && !strchr(error->text, '\n')));
}

/** One second each. */
static uint32_t stretch_of(void *user, double time)
{
    (void)user;
    return time > 0 ? (uint32_t)fmin(time, STRETCHES - 1) : 0;
}

/** Processes all available frames. */
static adcgs_status take_frames(adcgs_live_camera *camera, const adcgs_live_limits *limits, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    for (int progress = 1; status == ADCGS_OK && progress && camera->next < FRAMES_MOST;) {
        progress = 0;
        status = adcgs_live_camera_begin(camera, error);
        if (status == ADCGS_OK && camera->shape.frame_bytes)
            status = adcgs_live_camera_look(camera, limits, &progress, error);
        FUZZ_REQUIRE(camera->base <= camera->next && camera->n_missing <= camera->next);
    }
    for (int64_t i = camera->base; i < camera->next; i++)
        FUZZ_REQUIRE(!adcgs_live_camera_has(camera, i) || isfinite(adcgs_live_camera_time(camera, i)));
    return status;
}

static void remove_all(const adcgs_live_camera *camera, const adcgs_live_limits *limits, const char *video)
{
    for (uint32_t i = 0; i < STRETCHES; i++) {
        char *const spool = adcgs_live_camera_path(camera, 0, limits, i);
        FUZZ_REQUIRE(spool);
        unlink(spool);
        free(spool);
    }
    unlink(video);
    rmdir(limits->folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", video[64];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_live_camera camera;
    adcgs_live_limits limits = {.until = HUGE_VAL, .given_up = -HUGE_VAL, .folder = folder, .stretch = stretch_of};
    const size_t bytes = size - (size > 0), first = size ? bytes * *data / 256 : 0;
    FUZZ_REQUIRE(mkdtemp(folder));
    snprintf(video, sizeof video, "%s/v.y4m", folder);
    const adcgs_source_camera source = {.name = "a", .video = video};
    data += size > 0;
    write_outside_file(video, data, first);
    adcgs_live_camera_init(&camera, &source, 0);
    adcgs_status status = take_frames(&camera, &limits, &error);
    check(status, &error);
    write_outside_file(video, data, bytes); /* the same file, now longer */
    limits.is_end = 1;
    if (status == ADCGS_OK)
        check(take_frames(&camera, &limits, &error), &error);
    remove_all(&camera, &limits, video);
    adcgs_live_camera_clear(&camera);
    return 0;
}
