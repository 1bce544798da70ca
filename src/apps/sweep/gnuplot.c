/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes a chart's script and renders it by gnuplot, as SVG for the page and as PDF for papers. */
#include "apps/sweep/charts.h"

#include <unistd.h>

#define MISSING 127 /* exit code without gnuplot; definition (the command below; POSIX shells likewise) */

adcgs_status adcgs_chart_open(adcgs_atomic *file, const adcgs_sweep *sweep, const char *name, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    snprintf(path, sizeof path, "%s/%s.gp", sweep->directory, name);
    ADCGS_TRY(adcgs_atomic_open(file, path, error));
    fprintf(file->file,
            "# Plotted in this folder by: gnuplot %s.gp >%s.svg; as PDF by: gnuplot -e 'pdf=1' %s.gp >%s.pdf\n"
            "if (exists('pdf')) set terminal pdfcairo size 16cm,11.5cm noenhanced font 'sans-serif,11'; else "
            "set terminal svg size 860,620 noenhanced font 'sans-serif,12' background 'white'\n"
            "set grid\nset key below height 1 spacing 1.15\n",
            name, name, name, name);
    return ADCGS_OK;
}

/*
 * gnuplot runs in the folder, so that no path needs quotes. A missing gnuplot is not an error, nor is one without PDF. gnuplot
 * does not notice a full disk, but cat and sed do; a chart counts if its end is present. Dates become blanks, so that the same
 * figures make the same files; the number of characters stays, since offsets follow.
 */
adcgs_status adcgs_chart_draw(const adcgs_sweep *sweep, const char *name, int *drawn, adcgs_error *error)
{
    char command[] = "cd \"$1\" || exit 1; command -v gnuplot >/dev/null || exit 127; "
                     "if gnuplot -e 'set terminal pdfcairo' >/dev/null 2>&1; then "
                     "TZ=UTC0 gnuplot -e 'pdf=1' \"$2.gp\" | LC_ALL=C "
                     "sed 's|/CreationDate (D:[0-9]\\{14\\}Z)|                                 |' >\"$2.pdf.part\" && "
                     "tail -c 7 \"$2.pdf.part\" | grep -q '%%EOF' && "
                     "mv -f \"$2.pdf.part\" \"$2.pdf\" || { rm -f \"$2.pdf.part\"; exit 1; }; fi; "
                     "gnuplot \"$2.gp\" | cat >\"$2.svg.part\" && grep -q '</svg>' \"$2.svg.part\" && "
                     "mv -f \"$2.svg.part\" \"$2.svg\" || { rm -f \"$2.svg.part\"; exit 1; }";
    char sh[] = "/bin/sh", c[] = "-c";
    char *const argv[] = {sh, c, command, sh, (char *)(uintptr_t)sweep->directory, (char *)(uintptr_t)name, NULL};
    char log[ADCGS_SWEEP_PATH];
    int code = 0;
    snprintf(log, sizeof log, "%s/%s.gp.log", sweep->directory, name);
    unlink(log);
    ADCGS_TRY(adcgs_sweep_spawn(argv, NULL, log, &code, error));
    if (code == 0)
        unlink(log);
    *drawn = code == 0;
    if (code == 0 || code == MISSING)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s/%s.svg: cannot be made: gnuplot failed, see %s.gp.log", sweep->directory, name,
                      name);
}
