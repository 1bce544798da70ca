/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lifetimes of moving points. */
#include "config.h"

#include "init/lifetimes.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    /*
     * Frames: maximum distance of an end from the point's frame; calibrated on cross80 and the robot (doc/log/bodies.md,
     * "Length").
     */
    REACH = 3,
    OFF_LEAST = 3, /* minimum number of differing pixels of a 3x3 window that does not show background */
    PART = 256     /* points per job */
};
/* Share of the cameras that see the place and must show the background; 0.6 gains less on zju and cross80 (doc/log/bodies.md). */
#define BACKGROUND_SHARE_MIN 0.8
#define BACKGROUND_CAMERAS_MIN 2 /* least number of them; chosen by hand, not measured */

typedef struct job {
    adcgs_stereo_point *points;
    uint32_t n;
    const adcgs_stereo_rig *rig;
    const adcgs_depths *still; /* for each camera with a background, in order */
} job;

/** True if a camera shows its background around a pixel. */
static int shows_background(const adcgs_stereo_camera *c, int frame, int px, int py)
{
    int off = 0;
    for (int y = ADCGS_MAX(py - 1, 0); y <= ADCGS_MIN(py + 1, c->view.h - 1); y++)
        for (int x = ADCGS_MAX(px - 1, 0); x <= ADCGS_MIN(px + 1, c->view.w - 1); x++) {
            const int i = y * c->view.w + x;
            off += !c->frame[frame][4 * i + 3] || adcgs_stereo_rig_differs(c, frame, i);
        }
    return off < OFF_LEAST;
}

/** True if a point at this position would hide the background that most cameras show in the frame. */
static int is_gone(const job *j, int frame, const double x[3])
{
    int seen = 0, background = 0, map = 0;
    for (int c = 0; c < j->rig->n_cameras; c++) {
        const adcgs_stereo_camera *camera = &j->rig->camera[c];
        double at[2], depth, there[3];
        if (!camera->background)
            continue;
        const adcgs_depths *still = &j->still[map++];
        if (!camera->frame[frame] || !adcgs_stereo_rig_project(&camera->view, x, at, &depth) ||
            adcgs_depths_judge(still, x, there) == ADCGS_VERDICT_HIDDEN)
            continue;
        seen++;
        background += shows_background(camera, frame, (int)at[0], (int)at[1]);
    }
    return background >= BACKGROUND_CAMERAS_MIN && background >= BACKGROUND_SHARE_MIN * seen;
}

/** Time from the point's frame to its end, in direction `step` (1 or -1); 0 if there is no end in range. */
static float end_of(const job *j, const adcgs_stereo_point *p, int frame, int step)
{
    const adcgs_stereo_rig *rig = j->rig;
    for (int k = 1, m = frame + step; k <= REACH && m >= 0 && m < rig->n_frames; k++, m += step) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = p->x[a] + (double)p->velocity[a] * (double)(rig->frame_time[m] - p->t);
        if (is_gone(j, m, x))
            return fabsf(0.5f * (rig->frame_time[m] + rig->frame_time[m - step]) - p->t);
    }
    return 0;
}

static void find_ends(void *arg, int part, int thread)
{
    const job *j = arg;
    (void)thread;
    for (uint32_t i = (uint32_t)part * PART; i < j->n && i < ((uint32_t)part + 1) * PART; i++) {
        adcgs_stereo_point *p = &j->points[i];
        int frame = 0;
        while (frame + 1 < j->rig->n_frames && j->rig->frame_time[frame] < p->t)
            frame++;
        p->end[0] = end_of(j, p, frame, -1);
        p->end[1] = end_of(j, p, frame, 1);
    }
}

void adcgs_stereo_trim_lifetimes(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig, const adcgs_depths *still,
                                 adcgs_pool *pool)
{
    job j = {.points = points, .n = n, .rig = rig, .still = still};
    adcgs_pool_run(pool, find_ends, &j, (int)((n + PART - 1) / PART));
}
