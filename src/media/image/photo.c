/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Photos from cameras, by OpenImageIO. */
#include "config.h"

#include "media/image/photo.h"

#include "media/image/oiio_shim.h"
#include "system/file.h"

adcgs_status adcgs_photo_probe(adcgs_photo *out, const char *path, adcgs_error *error)
{
    int channels;
    *out = (adcgs_photo){.turn = ADCGS_PHOTO_UPRIGHT};
    ADCGS_TRY(adcgs_file_check(path, "an image", error));
    ADCGS_TRY(adcgs_image_probe(&out->width, &out->height, &channels, path, error));
    return adcgs_image_tell(out, path, error);
}

int adcgs_photo_lies(int turn)
{
    return turn > 4;
}

adcgs_status adcgs_photo_shape(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error)
{
    const adcgs_oiio *oiio;
    ADCGS_TRY(adcgs_oiio_get(&oiio, path, error));
    return oiio->shape(image, turn, width, height, path, error);
}
