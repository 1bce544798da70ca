/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths in the exchange format of Nuke and Blender: .chan. */
#include "config.h"

#include "camera/euler.h"
#include "camera/path_files.h"
#include "geometry/rotation.h"
#include "system/atomic.h"
#include "system/file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BLANKS " \t\r,"
/* Origin, unless a line states one: chosen by hand, not measured. */
#define BYTES_MAX ((uint64_t)256 << 20) /* of a file */
#define VALUE_MAX 1e9                   /* largest absolute value of a number */
#define DEGREE 0.017453292519943295     /* radians; definition */

/* Columns of a line, by definition of the format: frame, position, three angles, vertical field of view. */
enum { FRAME, PLACE, ANGLES = 4, VIEW = 7, COLUMNS };

/** Parse the numbers of a line. \return their count; -1 for other text */
static int read_numbers(char *line, double out[COLUMNS])
{
    char *rest = NULL;
    int n = 0;
    for (const char *word = strtok_r(line, BLANKS, &rest); word; word = strtok_r(NULL, BLANKS, &rest)) {
        char *end;
        if (n == COLUMNS)
            return -1;
        out[n] = strtod(word, &end);
        if (*end || !(fabs(out[n]) <= VALUE_MAX))
            return -1;
        n++;
    }
    return n;
}

static adcgs_status make_camera(const adcgs_path_reader *r, const double v[COLUMNS], int has_view, int line, adcgs_camera *camera)
{
    *camera = *r->like;
    snprintf(camera->name, sizeof camera->name, "frame %.0f", v[FRAME]);
    adcgs_euler_to_pose(v + ANGLES, r->request->order, camera->cam_to_world);
    for (int i = 0; i < 3; i++)
        camera->cam_to_world[4 * i + 3] = v[PLACE + i];
    adcgs_pose_other_axes(camera->cam_to_world);
    if (!has_view)
        return ADCGS_OK;
    if (!(v[VIEW] > 1e-4 && v[VIEW] < 179.9))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: a field of view of %g degrees", r->path, line, v[VIEW]);
    camera->fx = camera->fy = 0.5 * camera->height / tan(0.5 * DEGREE * v[VIEW]);
    camera->cx = 0.5 * camera->width;
    camera->cy = 0.5 * camera->height;
    return ADCGS_OK;
}

/** Read the keys of all lines; *gaps: true if frames are missing. */
static adcgs_status read_keys(const adcgs_path_reader *r, char *text, adcgs_camera_key *keys, int *n, int *gaps)
{
    double first = 0.0, last = 0.0;
    *n = *gaps = 0;
    for (int line = 1; *text; line++) {
        double v[COLUMNS];
        char *const end = text + strcspn(text, "\n"), *const next = *end ? end + 1 : end;
        *end = 0;
        text[strcspn(text, "#")] = 0;
        const int columns = read_numbers(text, v);
        text = next;
        if (!columns)
            continue;
        if (columns < VIEW || v[FRAME] != floor(v[FRAME]))
            return adcgs_fail(r->error, ADCGS_ERR_DATA,
                              "%s: line %d: expected a frame number, a position, three angles, and optionally a field of view",
                              r->path, line);
        if (*n && v[FRAME] <= last)
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: frame %.0f, expected one after %.0f", r->path, line,
                              v[FRAME], last);
        first = *n ? first : v[FRAME];
        *gaps |= *n && v[FRAME] != last + 1.0;
        last = v[FRAME];
        adcgs_camera_key *const key = &keys[(*n)++];
        key->at = (v[FRAME] - first) / r->info->frame_rate;
        key->frame.time = r->request->has_times ? r->request->begin : r->info->time_start + key->at;
        ADCGS_TRY(make_camera(r, v, columns == COLUMNS, line, &key->frame.camera));
    }
    return *n ? ADCGS_OK : adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: no frames", r->path);
}

/** One frame for each line, or interpolated frames if frame numbers are missing. */
static adcgs_status read_frames(adcgs_camera_path *out, const adcgs_path_reader *r, char *text, adcgs_camera_key *keys)
{
    int n, gaps;
    ADCGS_TRY(read_keys(r, text, keys, &n, &gaps));
    out->frame_rate = r->info->frame_rate; /* rate for the interpolation */
    if (gaps)
        return adcgs_path_fly(r, keys, (size_t)n, 0, out);
    ADCGS_TRY(adcgs_camera_path_alloc(out, n, r->path, r->error));
    out->frame_rate = r->info->frame_rate;
    for (int i = 0; i < n; i++)
        out->frame[i] = keys[i].frame;
    return ADCGS_OK;
}

adcgs_status adcgs_path_chan_read(adcgs_camera_path *out, const adcgs_path_reader *r)
{
    uint8_t *data;
    size_t bytes, lines = 1;
    ADCGS_TRY(adcgs_file_load_text(&data, &bytes, r->path, BYTES_MAX, r->error));
    for (size_t i = 0; i < bytes; i++)
        lines += data[i] == '\n';
    adcgs_camera_key *const keys = calloc(ADCGS_MIN(lines, ADCGS_PATH_FRAMES_MAX + 1), sizeof *keys);
    adcgs_status status = ADCGS_OK;
    if (!keys)
        status = adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory for %zu lines", r->path, lines);
    else if (memchr(data, 0, bytes))
        status = adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: not a text", r->path);
    else if (lines > ADCGS_PATH_FRAMES_MAX)
        status =
            adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %zu lines, expected at most %d", r->path, lines, ADCGS_PATH_FRAMES_MAX);
    else
        status = read_frames(out, r, (char *)data, keys);
    free(keys);
    free(data);
    return status;
}

/* ---- Writing ---- */

static void write_line(FILE *file, const adcgs_camera *camera, double number, adcgs_rotation_order order, double degrees[3])
{
    double pose[12];
    memcpy(pose, camera->cam_to_world, sizeof pose);
    adcgs_pose_other_axes(pose);
    adcgs_euler_from_pose(pose, order, degrees);
    fprintf(file, "%.0f", number);
    for (int i = 0; i < 3; i++)
        fprintf(file, "\t%.12g", pose[4 * i + 3]);
    for (int i = 0; i < 3; i++)
        fprintf(file, "\t%.12g", degrees[i]);
    fprintf(file, "\t%.12g\n", 2.0 * atan(0.5 * camera->height / camera->fy) / DEGREE);
}

adcgs_status adcgs_path_chan_write(const adcgs_camera_key *keys, int n, double frame_rate, adcgs_rotation_order order,
                                   const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    double number = 0.0, degrees[3] = {0};
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    for (int i = 0; i < n; i++) {
        number = fmax(number + 1.0, 1.0 + round((keys[i].at - keys[0].at) * frame_rate));
        write_line(atomic.file, &keys[i].frame.camera, number, order, degrees);
    }
    return adcgs_atomic_commit(&atomic, error);
}
