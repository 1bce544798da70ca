/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: writes the splats of one or several times as files. */
#include "config.h"

#include "apps/dec/dec_splats.h"

#include "apps/dec/dec_clip.h"
#include "apps/dec/dec_packed.h"
#include "media/sink.h"
#include "media/splats/offset.h"
#include "system/extension.h"
#include "system/interrupt.h"
#include "system/text.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>
#include <strings.h>

/** True for a format with all times in one file. */
static int is_one_file(const char *target)
{
    return adcgs_dec_clip_is(target) || adcgs_dec_packed_is(target);
}

static adcgs_status check_target(const adcgs_dec_splats_config *how, int has_many, adcgs_error *error)
{
    const char *const target = how->target;
    const int places = adcgs_pattern_places(target), is_clip = is_one_file(target);
    if ((is_clip || how->is_stable) && how->has_offset)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: --offset goes with a file for each time, without --stable", target);
    if (is_clip && how->style.axes)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: --axes goes with a file for each time", target);
    if (is_clip && (places || how->is_stable || how->style.rest_degree))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: one file has all times: expected no %s", target,
                          places           ? "number like %04d in the name"
                          : how->is_stable ? "--stable"
                                           : "--f-rest");
    if (is_clip)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_splats_check_name(target, &how->style, error));
    if (how->is_stable && (places != 1 || strcasecmp(adcgs_extension(target), "ply")))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: --stable writes PLY files, expected a name like time_%%05d.ply", target);
    if (places < 0 || places > 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected one number like %%04d in the name", target);
    if (!places && has_many)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a range of times needs a number like %%04d in the name", target);
    return ADCGS_OK;
}

/** The code for the axes of adcgs_info, which are words. */
static uint8_t axes_of(const adcgs_info *info)
{
    static const struct {
        const char *words;
        uint8_t code;
    } table[] = {{", y up", ADCGS_SPLATS_Y_UP}, {", z up", ADCGS_SPLATS_Z_UP}, {", y down", ADCGS_SPLATS_Y_DOWN}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (strstr(info->axes, table[i].words))
            return table[i].code;
    return ADCGS_SPLATS_UP_UNKNOWN;
}

static adcgs_status write_frame(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, double time,
                                const adcgs_dec_splats_config *how, const char *path, adcgs_error *error)
{
    adcgs_primitives primitives;
    adcgs_splats splats;
    char comment[128];
    adcgs_splats_style style = how->style;
    style.comment = comment;
    ADCGS_TRY(adcgs_get_primitives(decoder, time, &primitives, error));
    ADCGS_TRY(adcgs_splats_take(&splats, &primitives, info->scene_origin, info->scene_scale, how->has_offset ? how->offset : NULL,
                                path, error));
    splats.axes = axes_of(info);
    snprintf(comment, sizeof comment, "adcgs %s, time %.9g s", PACKAGE_VERSION, time);
    const adcgs_status status = adcgs_splats_write(&splats, &style, path, error);
    *n = splats.n;
    adcgs_splats_free(&splats);
    return status;
}

/** The files of frames with stable rows. */
typedef struct row_files {
    const adcgs_dec_splats_config *how;
    const adcgs_camera_path *frames;
    uint8_t axes;
    char *path; /**< [size] */
    size_t size;
} row_files;

static adcgs_status write_row_frame(void *user, int frame, const adcgs_splats *rows, adcgs_error *error)
{
    const row_files *const files = user;
    char comment[128];
    adcgs_splats splats = *rows;
    adcgs_splats_style style = files->how->style;
    splats.axes = files->axes;
    style.comment = comment;
    adcgs_pattern_format(files->how->target, frame, files->path, files->size);
    snprintf(comment, sizeof comment, "adcgs %s, time %.9g s", PACKAGE_VERSION, files->frames->frame[frame].time);
    return adcgs_splats_write(&splats, &style, files->path, error);
}

static adcgs_status write_rows(const adcgs_dec_rows *rows, adcgs_decoder *decoder, const adcgs_info *info,
                               const adcgs_dec_splats_config *how, const adcgs_camera_path *frames, adcgs_error *error)
{
    row_files files = {.how = how, .frames = frames, .axes = axes_of(info), .size = strlen(how->target) + 128};
    files.path = malloc(files.size);
    const adcgs_status status = files.path
                                    ? adcgs_dec_rows_each(rows, decoder, frames, how->target, write_row_frame, &files, error)
                                    : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", how->target);
    free(files.path);
    return status;
}

static adcgs_status write_stable(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, const adcgs_dec_splats_config *how,
                                 const adcgs_camera_path *frames, adcgs_error *error)
{
    adcgs_dec_rows rows;
    adcgs_status status = adcgs_dec_rows_find(&rows, decoder, info, frames, how->target, error);
    *n = rows.total;
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = write_rows(&rows, decoder, info, how, frames, error);
    adcgs_dec_rows_free(&rows);
    return status;
}

/** Reports that splats whose axes nobody knows are not turned. */
static void report_axes(const adcgs_cli *cli, const adcgs_dec_splats_config *how, const adcgs_info *info)
{
    static const char *const words[] = {"", "y up", "z up", "y down"};
    if (how->style.axes == ADCGS_SPLATS_KEEP || axes_of(info) != ADCGS_SPLATS_UP_UNKNOWN)
        return;
    adcgs_cli_note(cli, "%s: the stream's axes are unknown, expected %s: the splats are not turned; turn them in the viewer",
                   how->target, words[adcgs_splats_axes_for(how->target, &how->style, ADCGS_SPLATS_Z_UP)]);
}

/** Reports the offset, and its place in the file. */
static void report_offset(const adcgs_cli *cli, const adcgs_dec_splats_config *how, const adcgs_info *info,
                          const double offset[3])
{
    static const struct {
        const char *extension, *place;
    } formats[] = {{"glb", "the file's node adds it again"}, {"ply", "a comment of its header contains it"}};
    const char *place = "the format cannot store it, so the place in the world is lost: add it again";
    const uint8_t axes = axes_of(info);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        place = strcasecmp(adcgs_extension(how->target), formats[i].extension) ? place : formats[i].place;
    adcgs_cli_note(cli, "%s: the offset %.17g %.17g %.17g is subtracted from positions%s; %s", how->target, offset[0], offset[1],
                   offset[2],
                   adcgs_splats_axes_for(how->target, &how->style, axes) == axes ? "" : ", before the splats are turned", place);
}

/** Reports positions that are too coarse because the scene is still far from the origin. */
static void report_rounding(const adcgs_cli *cli, const adcgs_dec_splats_config *how, const adcgs_info *info,
                            const double offset[3])
{
    double left[3], advice[3], farthest = 0.0;
    for (int a = 0; a < 3; a++) {
        left[a] = info->scene_origin[a] - offset[a];
        farthest = fmax(farthest, fabs(left[a]));
    }
    if (!adcgs_offset_of(advice, left, info->scene_scale))
        return;
    adcgs_offset_of(advice, info->scene_origin, info->scene_scale);
    const int bits = strcasecmp(adcgs_extension(how->target), "spz") ? 23 : 22;
    adcgs_cli_note(
        cli,
        "%s: positions are up to %g from the origin, so they are rounded to steps of about %g, and the scene's scale is "
        "%g: give --offset %.17g,%.17g,%.17g",
        how->target, farthest, exp2(floor(log2(farthest)) - bits), info->scene_scale, advice[0], advice[1], advice[2]);
}

/** Reports turns, offsets and roundings that a user may not expect. */
static void report(const adcgs_cli *cli, const adcgs_dec_splats_config *given, const adcgs_info *info, int is_clip)
{
    adcgs_dec_splats_config plain = *given;
    const adcgs_dec_splats_config *const how = is_clip ? &plain : given;
    double offset[3];
    plain.style.axes = ADCGS_SPLATS_KEEP; /* splats over time in one file are not turned */
    adcgs_offset_of(offset, info->scene_origin, info->scene_scale);
    if (how->has_offset)
        memcpy(offset, how->offset, sizeof offset);
    report_axes(cli, how, info);
    if (adcgs_offset_is(offset))
        report_offset(cli, how, info, offset);
    report_rounding(cli, how, info, offset);
}

static adcgs_status write_all(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, const adcgs_dec_splats_config *how,
                              const adcgs_camera_path *frames, adcgs_error *error)
{
    const size_t size = strlen(how->target) + 128;
    char *path = malloc(size);
    if (!path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", how->target);
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < frames->n && status == ADCGS_OK && !adcgs_interrupted(); i++) {
        adcgs_pattern_format(how->target, i, path, size);
        status = write_frame(n, decoder, info, frames->frame[i].time, how, path, error);
    }
    free(path);
    return status;
}

adcgs_status adcgs_dec_splats(const adcgs_cli *cli, adcgs_decoder *decoder, const char *input, const adcgs_dec_splats_config *how,
                              const adcgs_camera_path_request *request, adcgs_error *error)
{
    const int is_clip = is_one_file(how->target);
    adcgs_info info;
    adcgs_camera_path frames;
    uint32_t n = 0;
    adcgs_camera_path_request times = {.has_times = 1, .begin = request->begin, .end = request->end};
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    if (!request->has_times) {
        times.begin = info.time_start;
        times.end = adcgs_pattern_places(how->target) == 0 && !is_clip ? info.time_start : info.time_end;
    }
    ADCGS_TRY(check_target(how, times.end > times.begin, error));
    if (info.truncated)
        adcgs_cli_note(cli, "%s: the stream ends early; writing its complete part", input);
    ADCGS_TRY(adcgs_camera_path_make(&frames, decoder, &times, error));
    if (frames.outside)
        adcgs_cli_note(cli,
                       "%s: %d of %d file%s %s its first or last frame: the stream lasts from %g to %g "
                       "s",
                       input, frames.outside, frames.n, adcgs_s((uint64_t)frames.n), frames.outside == 1 ? "shows" : "show",
                       info.time_start, info.time_end);
    const adcgs_status status = adcgs_dec_packed_is(how->target)
                                    ? adcgs_dec_packed_write(&n, decoder, &info, &frames, how->target, error)
                                : is_clip        ? adcgs_dec_clip_write(cli, decoder, &info, &frames, input, how->target, error)
                                : how->is_stable ? write_stable(&n, decoder, &info, how, &frames, error)
                                                 : write_all(&n, decoder, &info, how, &frames, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        report(cli, how, &info, is_clip);
    if (status == ADCGS_OK && !adcgs_interrupted() && adcgs_dec_packed_is(how->target))
        adcgs_cli_note(cli, "%s: 1 file, %d frames of %u splats", input, frames.n, n);
    if (status == ADCGS_OK && !adcgs_interrupted() && !is_clip)
        adcgs_cli_note(cli, "%s: %d file%s, %u splats in the last", input, frames.n, frames.n == 1 ? "" : "s", n);
    adcgs_camera_path_free(&frames);
    return status;
}
