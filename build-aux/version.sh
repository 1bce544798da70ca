#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Prints the version; the public header is its only source.
sed -n 's/^#define ADCGS_VERSION_\(MAJOR\|MINOR\|PATCH\) *//p' "$(dirname "$0")/../codec/include/adcgs/version.h" | paste -sd. -
