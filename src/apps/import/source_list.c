/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Detects the kind of footage from the operands. */
#include "config.h"

#include "apps/import/source_images.h"

#include "media/kind.h"
#include "media/video/video.h"
#include "system/paths.h"

adcgs_status adcgs_source_images_list(adcgs_source_images *out, const adcgs_import_options *options, adcgs_progress *progress,
                                      adcgs_error *error)
{
    int videos = 0;
    *out = (adcgs_source_images){0};
    for (int i = 0; i < options->n_inputs; i++) {
        const adcgs_kind *const kind = adcgs_kind_at(options->inputs[i]);
        if (kind->class == ADCGS_KIND_VIDEO && kind->advice) /* as of two fisheyes, also if its name ends in .mp4 */
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%.150s: %s, which is not read: %s", options->inputs[i], kind->name,
                              kind->advice);
        videos += adcgs_is_video(options->inputs[i]) && !adcgs_is_folder(options->inputs[i]);
    }
    if (videos && videos < options->n_inputs)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "expected either videos or images, not both");
    if (videos && options->fps.den)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--fps is for images only: a video has times of its own");
    return !videos       ? adcgs_source_images_photos(out, options, progress, error)
           : videos == 1 ? adcgs_source_images_video(out, options->inputs[0], options, error)
                         : adcgs_source_images_rig(out, options, progress, error);
}
