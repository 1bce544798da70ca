/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The whole public interface of libadcgs.
 */
#ifndef ADCGS_ADCGS_H
#define ADCGS_ADCGS_H

#include <adcgs/cpu.h>
#include <adcgs/decoder.h>
#include <adcgs/frame.h>
#include <adcgs/pool.h>
#include <adcgs/status.h>
#include <adcgs/types.h>
#include <adcgs/version.h>
#include <adcgs/view.h>

#endif
