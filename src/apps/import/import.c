/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The steps from footage to a scene, and the folder that appears only when it is complete. */
#include "config.h"

#include "apps/import/import.h"

#include "apps/import/colmap_run.h"
#include "apps/import/pose_judge.h"
#include "apps/import/scene_sound.h"
#include "apps/import/scene_write.h"
#include "system/atomic.h"
#include "system/file.h"
#include "system/paths.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define UNFINISHED ".importing"
#define STAMP "footage.txt"           /* fingerprint of the inputs of an unfinished folder */
#define STAMP_MAX ((uint64_t)1 << 28) /* bytes of the fingerprint; chosen by hand, not measured */

static const char *const kinds[] = {"pictures", "film", "rig"};

static adcgs_status no_memory(const adcgs_import_job *job)
{
    return adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->options->output);
}

/* ---- The folder ---- */

static void stamp_file(FILE *out, const char *path)
{
    struct stat s;
    if (!stat(path, &s))
        fprintf(out, "%s %lld %lld\n", path, (long long)s.st_size, (long long)s.st_mtime);
}

/** Writes the fingerprint of footage and options. If it is equal, the results of an unfinished run can be reused. */
static adcgs_status write_stamp(const adcgs_import_job *job, char **text, size_t *bytes)
{
    const adcgs_import_options *o = job->options;
    FILE *out = open_memstream(text, bytes);
    if (!out)
        return no_memory(job);
    fprintf(out, "adcgs-import %s %d %d %d %d %d %u/%u\n", PACKAGE_VERSION, o->side, o->frames, o->lens, o->own_lens,
            (int)job->sources.kind, o->fps.num, o->fps.den);
    if (o->masks)
        stamp_file(out, o->masks);
    for (uint32_t i = 0; i < job->sources.n_cameras; i++)
        if (job->sources.cameras[i].video)
            stamp_file(out, job->sources.cameras[i].video);
    for (uint32_t i = 0; i < job->sources.n; i++)
        if (job->sources.list[i].path)
            stamp_file(out, job->sources.list[i].path);
    return fclose(out) ? no_memory(job) : ADCGS_OK;
}

/** True if the folder was made by adcgs-import from the same footage and options. */
static int goes_on(const char *path, const char *text, size_t bytes)
{
    adcgs_error unused;
    uint8_t *data;
    size_t n;
    if (adcgs_file_load(&data, &n, path, STAMP_MAX, &unused) != ADCGS_OK)
        return 0;
    const int same = n == bytes && !memcmp(data, text, n);
    free(data);
    return same;
}

/**
 * Makes the folder, empty or with the results of an unfinished run on the same footage. A folder that adcgs-import did not make
 * is not touched.
 */
static adcgs_status open_folder(const adcgs_import_job *job, const char *stamp, const char *text, size_t bytes)
{
    if (adcgs_is_there(job->folder) && !adcgs_is_there(stamp) && rmdir(job->folder))
        return adcgs_fail(job->error, ADCGS_ERR_USAGE, "%s: exists and was not made by an unfinished import; move it away",
                          job->folder);
    if (adcgs_is_there(job->folder) && !goes_on(stamp, text, bytes))
        ADCGS_TRY(adcgs_import_remove_tree(job->folder, job->error));
    if (mkdir(job->folder, 0777) && errno != EEXIST)
        return adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", job->folder, strerror(errno));
    ADCGS_TRY(adcgs_atomic_save(stamp, text, bytes, job->error));
    ADCGS_TRY(adcgs_import_remove(job, "sparse")); /* a new log for a new run */
    return adcgs_import_remove(job, "colmap.log");
}

static adcgs_status begin(const adcgs_import_job *job)
{
    char *stamp, *text = NULL;
    size_t bytes = 0;
    ADCGS_TRY(adcgs_import_path(&stamp, job, STAMP));
    adcgs_status status = write_stamp(job, &text, &bytes);
    if (status == ADCGS_OK)
        status = open_folder(job, stamp, text, bytes);
    free(text);
    free(stamp);
    return status;
}

/** Removes the stamp last, so that a folder that could not be renamed is still recognised. */
static adcgs_status remove_stamp(const adcgs_import_job *job)
{
    char *stamp = adcgs_path("%s/" STAMP, job->options->output);
    const adcgs_status status = stamp ? adcgs_import_remove_tree(stamp, job->error) : no_memory(job);
    free(stamp);
    return status;
}

/** Removes intermediate files and renames the folder. The images of a rig were for COLMAP only. */
static adcgs_status finish(const adcgs_import_job *job)
{
    static const char *const scaffolding[] = {"sparse", "database.db", "database.db-shm", "database.db-wal", "colmap.log"};
    if (job->sources.kind == ADCGS_FOOTAGE_RIG)
        ADCGS_TRY(adcgs_import_remove(job, "images"));
    for (uint32_t i = 0; job->sources.kind == ADCGS_FOOTAGE_RIG && job->options->masks && i < job->sources.n_cameras; i++) {
        char *name = adcgs_path("masks/%s", job->sources.cameras[i].folder);
        const adcgs_status status = name ? adcgs_import_remove(job, name) : no_memory(job);
        free(name);
        ADCGS_TRY(status);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(scaffolding); i++)
        ADCGS_TRY(adcgs_import_remove(job, scaffolding[i]));
    if (rename(job->folder, job->options->output))
        return adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot rename to %s: %s", job->folder, job->options->output,
                          strerror(errno));
    return remove_stamp(job);
}

/* ---- The steps ---- */

static void report_footage(const adcgs_import_job *job)
{
    const adcgs_source_images *sources = &job->sources;
    adcgs_import_report *r = job->report;
    const adcgs_source_image_camera *first = &sources->cameras[0];
    r->kind = kinds[sources->kind];
    r->pictures = sources->n;
    r->hdr = sources->hdr;
    r->is_numbered = sources->is_numbered && sources->kind == ADCGS_FOOTAGE_PICTURES;
    for (uint32_t i = 0; i < sources->n; i++)
        r->seconds = fmax(r->seconds, sources->list[i].time);
    if (sources->kind == ADCGS_FOOTAGE_RIG)
        r->seconds = (double)(first->frames - 1) / adcgs_fps_value(first->rate);
}

static adcgs_status make_scene(adcgs_import_job *job, const adcgs_colmap_program *program)
{
    adcgs_poses poses;
    ADCGS_TRY(begin(job));
    ADCGS_TRY(adcgs_import_pictures(job));
    ADCGS_TRY(adcgs_import_poses(job, program));
    ADCGS_TRY(adcgs_poses_read(&poses, job));
    adcgs_status status = adcgs_import_judge(job);
    if (status == ADCGS_OK && job->sources.kind == ADCGS_FOOTAGE_RIG)
        status = adcgs_import_videos(job);
    if (status == ADCGS_OK)
        status = adcgs_import_sound(&poses, job);
    if (status == ADCGS_OK)
        status = adcgs_import_write(&poses, job);
    adcgs_poses_clear(&poses);
    return status == ADCGS_OK ? finish(job) : status;
}

static adcgs_status run(adcgs_import_job *job)
{
    const adcgs_import_options *o = job->options;
    adcgs_colmap_program program;
    if (adcgs_is_there(o->output))
        return adcgs_fail(job->error, ADCGS_ERR_USAGE, "%s: exists already", o->output);
    if (o->vocab_tree)
        ADCGS_TRY(adcgs_file_check(o->vocab_tree, "COLMAP's vocabulary tree", job->error));
    ADCGS_TRY(adcgs_import_ask(&program, o, job->error));
    ADCGS_TRY(adcgs_source_images_list(&job->sources, o, job->progress, job->error));
    report_footage(job);
    if (!(job->folder = adcgs_path("%s" UNFINISHED, o->output)) || !(job->log = adcgs_path("%s/colmap.log", job->folder)))
        return no_memory(job);
    return make_scene(job, &program);
}

adcgs_status adcgs_import(const adcgs_import_options *options, adcgs_progress *progress, adcgs_import_report *report,
                          adcgs_error *error)
{
    adcgs_import_job job = {.options = options, .progress = progress, .report = report, .error = error};
    *report = (adcgs_import_report){.kind = ""};
    const adcgs_status status = run(&job);
    adcgs_source_images_clear(&job.sources);
    free(job.folder);
    free(job.log);
    return status;
}
