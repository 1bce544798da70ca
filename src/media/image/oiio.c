/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The module with OpenImageIO. */
#include "config.h"

#include "media/image/oiio_shim.h"

ADCGS_MODULE_GET(adcgs_oiio_get, adcgs_oiio, adcgs_oiio_table, "adcgs_oiio.so", "images need OpenImageIO")
