/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The version of the library that is running. */
#include <adcgs/version.h>

#define TEXT_OF(a) #a
#define TEXT(a) TEXT_OF(a)

uint32_t adcgs_version_number(void)
{
    return ADCGS_VERSION;
}

const char *adcgs_version_string(void)
{
    return TEXT(ADCGS_VERSION_MAJOR) "." TEXT(ADCGS_VERSION_MINOR) "." TEXT(ADCGS_VERSION_PATCH);
}
