/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs that train the same model together. */
#include "train/team/team.h"

#include "train/team/tree_sum.h"

adcgs_status adcgs_team_broadcast(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error)
{
    adcgs_ranks_part parts[ADCGS_TREE_MOST];
    const int n = !team ? 0 : team->rank ? 1 : team->size - 1;
    if (!n)
        return ADCGS_OK;
    for (int i = 0; i < n; i++)
        parts[i] = (adcgs_ranks_part){team->rank ? 0 : i + 1, data, bytes};
    return team->rank ? team->swap(team->user, NULL, 0, parts, n, error) : team->swap(team->user, parts, n, NULL, 0, error);
}

adcgs_status adcgs_team_gather(const adcgs_team *team, void *data, const size_t *at, adcgs_error *error)
{
    adcgs_ranks_part out[ADCGS_TREE_MOST], in[ADCGS_TREE_MOST];
    char *const bytes = data;
    const int own = team->rank;
    int n = 0;
    for (int r = 0; r < team->size; r++) {
        if (r == own)
            continue;
        out[n] = (adcgs_ranks_part){r, bytes + at[own], at[own + 1] - at[own]};
        in[n++] = (adcgs_ranks_part){r, bytes + at[r], at[r + 1] - at[r]};
    }
    return team->swap(team->user, out, n, in, n, error);
}

adcgs_status adcgs_team_gather_each(const adcgs_team *team, void *data, size_t bytes, adcgs_error *error)
{
    size_t at[ADCGS_TREE_MOST + 1];
    for (int r = 0; r <= team->size; r++)
        at[r] = (size_t)r * bytes;
    return adcgs_team_gather(team, data, at, error);
}
