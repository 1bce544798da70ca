/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What kind of footage operands are. */
#include "config.h"

#include "import/shots.h"

#include "data/paths.h"
#include "io/video.h"

adcgs_status adcgs_shots_list(adcgs_shots *out, const adcgs_import_options *options, adcgs_progress *progress,
                              adcgs_error *error)
{
    int videos = 0;
    *out = (adcgs_shots){0};
    for (int i = 0; i < options->n_inputs; i++)
        videos += adcgs_is_video(options->inputs[i]) && !adcgs_is_folder(options->inputs[i]);
    if (videos && videos < options->n_inputs)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "expected either videos or pictures, not both");
    if (videos && options->fps.den)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--fps is for pictures: a video says itself when its frames were taken");
    return !videos       ? adcgs_shots_pictures(out, options, progress, error)
           : videos == 1 ? adcgs_shots_film(out, options->inputs[0], options, error)
                         : adcgs_shots_rig(out, options, progress, error);
}
