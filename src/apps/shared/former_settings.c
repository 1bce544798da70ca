/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Remarks about former names of settings on the command line. */
#include "apps/shared/former_settings.h"

#include "train/settings.h"

void adcgs_former_settings_report(const adcgs_cli *cli, const char *list)
{
    for (const adcgs_setting_former *former; (former = adcgs_setting_next_former(&list));)
        adcgs_cli_note(cli, "setting '%s' is now called '%s'; the next release drops the former name", former->name, former->now);
}
