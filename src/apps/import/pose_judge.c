/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether poses suffice for a scene, in words for the person who filmed it. */
#include "config.h"

#include "apps/import/pose_judge.h"

/** Refuses a scene in which too small a share of the images has a pose. */
static adcgs_status judge_number(const adcgs_import_job *job)
{
    static const char *const things[] = {"images", "frames", "cameras"};
    static const char *const advice[] = {
        "photograph in small steps, with most of the last image in each",
        "film slowly and without blur, or choose another piece",
        "turn the cameras so that the views of neighbours overlap by half",
    };
    const adcgs_import_report *const r = job->report;
    const int kind = (int)job->sources.kind;
    const uint32_t all = r->cameras ? r->cameras : r->pictures, found = r->cameras ? r->found : r->posed;
    if (found >= ADCGS_IMPORT_POSED_LEAST * all)
        return ADCGS_OK;
    return ADCGS_IMPORT_FAIL(job, ADCGS_ERR_DATA,
                             "only %u of %u %s have a place in space, expected half of them or more: %s; --anyway makes a scene "
                             "of these %u",
                             found, all, things[kind], advice[kind], found);
}

/** Refuses a pan, and cameras that all stand in one place. */
static adcgs_status judge_parallax(const adcgs_import_job *job)
{
    const adcgs_import_report *const r = job->report;
    const int stands = job->sources.kind == ADCGS_FOOTAGE_RIG;
    if (!r->points || r->angle >= ADCGS_IMPORT_ANGLE_LEAST)
        return ADCGS_OK;
    return ADCGS_IMPORT_FAIL(job, ADCGS_ERR_DATA,
                             "%s: half of the points are seen from directions within %.2g degrees, expected %g or more: %s; "
                             "--anyway makes a scene",
                             stands ? "the cameras stand too close together" : "the camera hardly moves sideways", r->angle,
                             ADCGS_IMPORT_ANGLE_LEAST,
                             stands ? "place them around the subject" : "walk round the subject, or choose a longer piece");
}

adcgs_status adcgs_import_judge(const adcgs_import_job *job)
{
    if (job->options->anyway)
        return ADCGS_OK;
    ADCGS_TRY(judge_number(job));
    return judge_parallax(job);
}
