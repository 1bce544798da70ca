/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene of an instance of the module. */
#ifndef ADCGS_WEB_PAGE_SCENE_H
#define ADCGS_WEB_PAGE_SCENE_H

#include <adcgs/types.h>

/** NULL before the first bytes. */
adcgs_decoder *adcgs_page_decoder(void);

/** The error that page_error() reports. */
adcgs_error *adcgs_page_error(void);

/** Make a line of text the error that page_error() reports. \return status */
adcgs_status adcgs_page_fail(adcgs_status status, const char *text);

#endif
