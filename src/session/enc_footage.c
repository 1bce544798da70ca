/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Messages on footage. */
#include "config.h"

#include "session/enc_footage.h"

static void report(const adcgs_cli *cli, adcgs_findings *findings)
{
    for (int i = 0; i < findings->n; i++)
        adcgs_cli_note(cli, "%s", findings->list[i].text);
    adcgs_findings_clear(findings);
}

void adcgs_enc_diagnose_footage(const adcgs_cli *cli, const adcgs_footage_facts *facts, adcgs_pool *pool, unsigned *known)
{
    adcgs_findings findings = {.n = 0};
    adcgs_check_footage(&findings, facts, pool, known);
    report(cli, &findings);
}

void adcgs_enc_report_remarks(const adcgs_cli *cli, const adcgs_scene *scene)
{
    for (int i = 0; i < scene->n_remarks; i++)
        adcgs_cli_note(cli, "%s", scene->remarks[i]);
}

void adcgs_enc_report_light(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *light)
{
    adcgs_findings findings = {.n = 0};
    if (light->cameras)
        adcgs_find_light(&findings, scene, light, 0, 1);
    else
        adcgs_cli_note(cli, "%s: exposure_step_compensation: no steps of light found", scene->directory);
    report(cli, &findings);
}
