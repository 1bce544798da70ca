/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The statistics behind a model's size. */
#include "train/state/decisions.h"

#include <stdio.h>
#include <string.h>

void adcgs_decisions_walk(adcgs_checkpoint_walk *walk, adcgs_decisions *decisions)
{
    adcgs_checkpoint_visit(walk, decisions, sizeof *decisions);
}

void adcgs_decisions_list(const adcgs_decisions *d, adcgs_decision list[ADCGS_DECISIONS])
{
    const adcgs_decision all[] = {
        {"details", d->details},
        {"allowed", d->allowed},
        {"points", (double)d->points},
        {"began", d->began},
        {"most", d->most},
        {"refused", d->refused},
        {"idle", d->idle},
        {"unseen", d->unseen},
        {"faint", d->faint},
        {"unchanging", d->unchanging},
        {"unmoved", d->unmoved},
        {"units", d->units},
        {"still", d->loss_still},
        {"moving", d->loss_moving},
    };
    _Static_assert(sizeof all == ADCGS_DECISIONS * sizeof *all, "each decision has its name");
    memcpy(list, all, sizeof all);
}

void adcgs_decisions_format(const adcgs_decisions *d, char text[ADCGS_DECISIONS_TEXT])
{
    adcgs_decision list[ADCGS_DECISIONS];
    size_t n = 0;
    adcgs_decisions_list(d, list);
    text[0] = '\0';
    for (int i = 0; i < ADCGS_DECISIONS; i++)
        if (list[i].value > 0)
            n += (size_t)snprintf(text + n, ADCGS_DECISIONS_TEXT - n, "%s%s=%.*g", n ? " " : "", list[i].name,
                                  list[i].value < 1 ? 4 : 10, list[i].value);
}
