/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Remarks about former names of settings on the command line. */
#ifndef ADCGS_APPS_SHARED_FORMER_SETTINGS_H
#define ADCGS_APPS_SHARED_FORMER_SETTINGS_H

#include "cli/cli.h"

/** Prints a remark with the present name of each setting that a list for adcgs_train_set() gives by a former name. */
void adcgs_former_settings_report(const adcgs_cli *cli, const char *list);

#endif
