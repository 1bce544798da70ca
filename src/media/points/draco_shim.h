/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * C interface to Draco. No exception and no C++ type crosses it. The shim is a
 * module, opened when the first Draco file is read or written, so that programs
 * start without it. A build without shared libraries links it.
 */
#ifndef ADCGS_MEDIA_POINTS_DRACO_SHIM_H
#define ADCGS_MEDIA_POINTS_DRACO_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "media/points/points.h"
#include "system/module.h"

/** Functions of the module. Any thread may call them. */
typedef struct adcgs_draco {
    const char *version; /**< version of the programs that the module belongs to */
    /** See adcgs_draco_parse(). */
    adcgs_status (*parse)(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
    /** Encode the file that adcgs_draco_write() writes, in memory; the caller free()s *data. */
    adcgs_status (*encode)(uint8_t **data, size_t *bytes, const adcgs_points *points, const char *path, adcgs_error *error);
} adcgs_draco;

/** The module's only exported symbol. */
ADCGS_MODULE_EXPORT extern const adcgs_draco adcgs_draco_table;

/** The module's table (see module.h). path: the file that messages name. ADCGS_ERR_UNSUPPORTED if the module is missing. */
adcgs_status adcgs_draco_get(const adcgs_draco **draco, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
