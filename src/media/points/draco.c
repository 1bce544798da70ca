/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module with Draco. */
#include "config.h"

#include "media/points/draco_shim.h"

#ifdef HAVE_ENCODER

ADCGS_MODULE_GET(adcgs_draco_get, adcgs_draco, adcgs_draco_table, "adcgs_draco.so", "its points need Draco")

#else

adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build has no Draco", path);
}

#endif
