/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The representative run of a sweep, and its test views. */
#include "config.h"

#include "apps/sweep/run.h"

#include "scene/camera_json.h"

#include <math.h>
#include <stdlib.h>

const char *adcgs_portion_name(adcgs_portion_kind kind)
{
    static const char *const names[ADCGS_PORTION_COUNT] =
        {[ADCGS_PORTION_LAYERS] = "layers", [ADCGS_PORTION_TIERS] = "tiers", [ADCGS_PORTION_PERCENT] = "percent"};
    return names[kind];
}

/** The first seed of the middle lambda of the first curve. NULL if it has no result. */
static const adcgs_sweep_run *choose(const adcgs_sweep_plan *plan)
{
    const adcgs_sweep_curve *const curve = &plan->curve[0];
    if (!plan->n_curves || curve->earlier || !curve->n)
        return NULL;
    const adcgs_sweep_run *const run = &plan->run[plan->cell[curve->cell[curve->n / 2]].run[0]];
    return run->state == ADCGS_RUN_DONE ? run : NULL;
}

/** Results of early versions lack cameras: each view then counts as a camera of its own. */
static adcgs_sweep_view view_of(const json_t *report, int index)
{
    const double camera = adcgs_sweep_number(report, "camera");
    adcgs_sweep_view view = {.camera = camera >= 0 ? (int)camera : index,
                             .time = adcgs_sweep_number(report, "time"),
                             .psnr = adcgs_sweep_number(report, "psnr"),
                             .moving = adcgs_sweep_number(report, "dynamic_psnr")};
    const char *const name = json_string_value(json_object_get(report, "name"));
    snprintf(view.name, sizeof view.name, "%s", name ? name : "");
    return view;
}

static adcgs_status take_views(adcgs_sweep_shown *shown, const json_t *views, adcgs_error *error)
{
    const size_t n = json_array_size(views);
    shown->view = calloc(n + 1, sizeof *shown->view);
    if (!shown->view)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %zu views", n);
    for (; shown->n_views < (int)n; shown->n_views++)
        shown->view[shown->n_views] = view_of(json_array_get(views, (size_t)shown->n_views), shown->n_views);
    return ADCGS_OK;
}

adcgs_status adcgs_sweep_show(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    json_t *root;
    plan->shown.run = choose(plan);
    if (!plan->shown.run)
        return ADCGS_OK;
    adcgs_sweep_path(path, sweep, plan->shown.run, ".json");
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    const adcgs_status status = take_views(&plan->shown, json_object_get(json_object_get(root, "evaluation"), "views"), error);
    json_decref(root);
    return status;
}
