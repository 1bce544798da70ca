/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The quality of parts of a stream: its first layers, its first tiers, its first bytes. The bytes of each part follow from the
 * list of chunks, its quality from decoding it. Both are stored next to the run's result.
 */
#include "config.h"

#include "apps/sweep/run.h"

#include "scene/camera_json.h"
#include "system/atomic.h"

#include <errno.h>
#include <math.h>
#include <unistd.h>

#define STEP 10 /* step of prefixes, percent; chosen by hand, not measured */
#define KEPT ".portions.json"

/* ---- List ---- */

/** Adds a part that is not measured yet; NULL if there are too many, which no stream has. */
static adcgs_sweep_portion *add(adcgs_sweep_shown *shown, adcgs_portion_kind kind, int count, double bytes)
{
    if (shown->n_portions == ADCGS_SWEEP_PORTIONS)
        return NULL;
    adcgs_sweep_portion *const p = &shown->portion[shown->n_portions++];
    *p = (adcgs_sweep_portion){.kind = kind, .count = count, .bytes = bytes, .psnr = (double)NAN, .moving = (double)NAN};
    return p;
}

/** The bytes of a chunk with its header, from its offset to that of the next. */
static double size_of(const json_t *chunks, size_t index)
{
    return adcgs_sweep_number(json_array_get(chunks, index + 1), "offset") -
           adcgs_sweep_number(json_array_get(chunks, index), "offset");
}

/** True if a chunk's type is, or begins with, the given one. */
static int is_of_type(const json_t *chunks, size_t index, const char *type)
{
    const char *const own = json_string_value(json_object_get(json_array_get(chunks, index), "type"));
    return own && !strncmp(own, type, strlen(type));
}

/**
 * Returns the bytes of a stream without the chunks beyond its first layers and, in each segment, its first tiers. It also
 * subtracts the digests, which cover only whole models. The result equals the size that adcgs-info --bytes gives.
 */
static double size_of_first(double total, const json_t *chunks, int layers, int tiers)
{
    double absent = 0, digests = 0;
    int tier = -1;
    for (size_t i = 0; i < json_array_size(chunks); i++) {
        const int is_positions = is_of_type(chunks, i, "GEOM"), is_features = is_of_type(chunks, i, "FEA");
        const char *const type = json_string_value(json_object_get(json_array_get(chunks, i), "type"));
        tier = is_of_type(chunks, i, "SEGM") ? -1 : tier + is_positions;
        if (((is_positions || is_features) && tier >= tiers) || (is_features && type[3] - '0' >= layers))
            absent += size_of(chunks, i);
        else if (is_of_type(chunks, i, "hash"))
            digests += size_of(chunks, i);
    }
    return absent > 0 ? total - absent - digests : total;
}

/** A predicted segment takes anchors from all tiers of the previous one, so none of their bytes can be left out. */
static int is_predicted(const json_t *chunks)
{
    for (size_t i = 0; i < json_array_size(chunks); i++)
        if (is_of_type(chunks, i, "KEEP"))
            return 1;
    return 0;
}

/** Lists all possible parts; a single layer or tier gives none. */
static void list(adcgs_sweep_shown *shown, const json_t *info)
{
    const json_t *const chunks = json_object_get(info, "chunks");
    const double total = shown->run->figure[ADCGS_FIGURE_BYTES];
    const int layers = (int)json_integer_value(json_object_get(info, "layers"));
    const int tiers = is_predicted(chunks) ? 1 : (int)json_integer_value(json_object_get(info, "tiers"));
    for (int i = 1; layers > 1 && i <= layers; i++)
        add(shown, ADCGS_PORTION_LAYERS, i, size_of_first(total, chunks, i, tiers));
    for (int i = 1; tiers > 1 && i <= tiers; i++)
        add(shown, ADCGS_PORTION_TIERS, i, size_of_first(total, chunks, layers, i));
    for (int i = STEP; i <= 100; i += STEP)
        add(shown, ADCGS_PORTION_PERCENT, i, floor(total * i / 100));
}

/** Asks adcgs-info for its report on a run's stream. The caller calls json_decref() on the root. */
static adcgs_status ask(const adcgs_sweep *sweep, const adcgs_sweep_run *run, json_t **root, adcgs_error *error)
{
    char program[ADCGS_SWEEP_PATH], file[ADCGS_SWEEP_PATH], out[ADCGS_SWEEP_PATH];
    adcgs_command c = {.n = 0};
    snprintf(program, sizeof program, "%s/adcgs-info", sweep->programs);
    adcgs_sweep_path(file, sweep, run, ".adcgs");
    adcgs_sweep_path(out, sweep, run, ".info.part");
    adcgs_command_word(&c, program);
    adcgs_command_word(&c, "--json");
    adcgs_command_word(&c, "--");
    adcgs_command_word(&c, file);
    adcgs_status status = adcgs_sweep_call(sweep, run, &c, out, error);
    if (status == ADCGS_OK)
        status = adcgs_json_load(root, out, error);
    unlink(out);
    return status;
}

/* ---- Stored measurements ---- */

static adcgs_status save(const adcgs_sweep *sweep, const adcgs_sweep_shown *shown, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    json_t *const all = json_array();
    for (int i = 0; i < shown->n_portions; i++) {
        const adcgs_sweep_portion *const p = &shown->portion[i];
        json_t *const one = json_pack("{s:s, s:i, s:f}", "of", adcgs_portion_name(p->kind), "count", p->count, "bytes", p->bytes);
        if (p->is_known) {
            json_object_set_new(one, "psnr", isfinite(p->psnr) ? json_real(p->psnr) : json_null());
            json_object_set_new(one, "dynamic_psnr", isfinite(p->moving) ? json_real(p->moving) : json_null());
        }
        json_array_append_new(all, one);
    }
    adcgs_sweep_path(path, sweep, shown->run, KEPT);
    return adcgs_sweep_save(json_pack("{s:o, s:o}", "settings", adcgs_sweep_settings(sweep, shown->run), "portions", all), path,
                            error);
}

static void read_portion(adcgs_sweep_shown *shown, const json_t *kept)
{
    const char *const of = json_string_value(json_object_get(kept, "of"));
    for (int kind = 0; of && kind < ADCGS_PORTION_COUNT; kind++) {
        if (strcmp(of, adcgs_portion_name(kind)) != 0)
            continue;
        const int count = (int)json_integer_value(json_object_get(kept, "count"));
        adcgs_sweep_portion *const p = add(shown, kind, count, adcgs_sweep_number(kept, "bytes"));
        if (!p)
            return;
        p->is_known = json_object_get(kept, "psnr") != NULL;
        p->psnr = adcgs_sweep_number(kept, "psnr");
        p->moving = adcgs_sweep_number(kept, "dynamic_psnr");
    }
}

/** Loads the list of an earlier sweep; 0 if there is none. Making a stream again removes it. */
static int find_kept(const adcgs_sweep *sweep, adcgs_sweep_shown *shown)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_error ignored;
    json_t *root;
    adcgs_sweep_path(path, sweep, shown->run, KEPT);
    if (adcgs_json_load(&root, path, &ignored) != ADCGS_OK)
        return 0;
    const json_t *const kept = json_object_get(root, "portions");
    for (size_t i = 0; adcgs_sweep_same_settings(sweep, shown->run, root) && i < json_array_size(kept); i++)
        read_portion(shown, json_array_get(kept, i));
    json_decref(root);
    return shown->n_portions > 0;
}

adcgs_status adcgs_sweep_list_portions(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, adcgs_error *error)
{
    adcgs_sweep_shown *const shown = &plan->shown;
    json_t *info;
    if (!shown->run)
        return ADCGS_OK;
    if (!find_kept(sweep, shown)) {
        ADCGS_TRY(ask(sweep, shown->run, &info, error));
        list(shown, info);
        json_decref(info);
    }
    for (int i = 0; i < shown->n_portions; i++) {
        adcgs_sweep_portion *const p = &shown->portion[i];
        if (!(p->bytes >= shown->run->figure[ADCGS_FIGURE_BYTES]))
            continue;
        p->is_known = 1; /* the run's own figures apply to the whole stream */
        p->psnr = shown->run->figure[ADCGS_FIGURE_PSNR];
        p->moving = shown->run->figure[ADCGS_FIGURE_MOVING];
    }
    return ADCGS_OK;
}

/* ---- Measuring ---- */

/** Copies the first bytes of a file to another. */
static adcgs_status copy_first(const char *from, const char *to, size_t bytes, adcgs_error *error)
{
    char buffer[65536];
    adcgs_atomic file;
    FILE *const in = fopen(from, "rb");
    if (!in)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", from, strerror(errno));
    adcgs_status status = adcgs_atomic_open(&file, to, error);
    if (status != ADCGS_OK) {
        fclose(in);
        return status;
    }
    for (size_t n; bytes && (n = fread(buffer, 1, ADCGS_MIN(bytes, sizeof buffer), in)) > 0; bytes -= n)
        fwrite(buffer, 1, n, file.file);
    fclose(in);
    if (!bytes)
        return adcgs_atomic_commit(&file, error);
    adcgs_atomic_abort(&file);
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot be read to its end", from);
}

static adcgs_status evaluate(const adcgs_sweep *sweep, const adcgs_sweep_run *run, const adcgs_sweep_portion *p, const char *out,
                             adcgs_error *error)
{
    static const char *const options[ADCGS_PORTION_COUNT] = {"--layers", "--tiers", NULL};
    char file[ADCGS_SWEEP_PATH], prefix[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(file, sweep, run, ".adcgs");
    if (options[p->kind])
        return adcgs_sweep_evaluate(sweep, run, file, options[p->kind], p->count, out, error);
    adcgs_sweep_path(prefix, sweep, run, ".prefix.part");
    adcgs_status status = copy_first(file, prefix, (size_t)p->bytes, error);
    if (status == ADCGS_OK)
        status = adcgs_sweep_evaluate(sweep, run, prefix, NULL, 0, out, error);
    unlink(prefix);
    return status;
}

adcgs_status adcgs_sweep_measure_portion(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int index, adcgs_error *error)
{
    adcgs_sweep_portion *const p = &plan->shown.portion[index];
    char out[ADCGS_SWEEP_PATH];
    json_t *root = NULL;
    if (p->is_known)
        return ADCGS_OK;
    adcgs_sweep_path(out, sweep, plan->shown.run, ".eval.part");
    adcgs_status status = evaluate(sweep, plan->shown.run, p, out, error);
    if (status == ADCGS_OK)
        status = adcgs_json_load(&root, out, error);
    else if (status == ADCGS_ERR_DATA)
        status = ADCGS_OK; /* too little to render anything, which is a result, too */
    unlink(out);
    ADCGS_TRY(status);
    p->is_known = 1;
    p->psnr = adcgs_sweep_number(root, "psnr");
    p->moving = adcgs_sweep_number(root, "dynamic_psnr");
    json_decref(root);
    return save(sweep, &plan->shown, error);
}
