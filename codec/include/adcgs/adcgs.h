/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Everything that libadcgs offers. */
#ifndef ADCGS_ADCGS_H
#define ADCGS_ADCGS_H

#include <adcgs/camera.h>
#include <adcgs/decoder.h>
#include <adcgs/status.h>
#include <adcgs/version.h>

#endif
