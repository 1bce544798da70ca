/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Extracts images from videos, rotates them upright and reduces them. */
#include "config.h"

#include "apps/import/scene_images.h"

#include "media/image/photo.h"
#include "media/video/video.h"
#include "system/atomic.h"
#include "system/extension.h"
#include "system/file.h"
#include "system/interrupt.h"
#include "system/paths.h"

#include <errno.h>
#include <ftw.h>
#include <stdlib.h>
#include <sys/stat.h>

#define PICTURE_BYTES_MAX ((uint64_t)1 << 30) /* bytes of an image file; chosen by hand, not measured */

adcgs_status adcgs_import_path(char **out, const adcgs_import_job *job, const char *name)
{
    *out = adcgs_path("%s/%s", job->folder, name);
    return *out ? ADCGS_OK : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->folder);
}

adcgs_status adcgs_import_make_folder(const adcgs_import_job *job, const char *name)
{
    char *path;
    ADCGS_TRY(adcgs_import_path(&path, job, name));
    adcgs_status status = ADCGS_OK;
    if (mkdir(path, 0777) && errno != EEXIST)
        status = adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", path, strerror(errno));
    free(path);
    return status;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

adcgs_status adcgs_import_remove_tree(const char *path, adcgs_error *error)
{
    if (nftw(path, remove_entry, 8, FTW_DEPTH | FTW_PHYS) && errno != ENOENT)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot remove: %s", path, strerror(errno));
    return ADCGS_OK;
}

adcgs_status adcgs_import_remove(const adcgs_import_job *job, const char *name)
{
    char *path;
    ADCGS_TRY(adcgs_import_path(&path, job, name));
    const adcgs_status status = adcgs_import_remove_tree(path, job->error);
    free(path);
    return status;
}

adcgs_status adcgs_import_goes_on(const adcgs_import_job *job)
{
    if (!adcgs_interrupted())
        return ADCGS_OK;
    return adcgs_fail(job->error, ADCGS_ERR_IO, "interrupted; run the same command again to continue from %s", job->folder);
}

/* ---- One image ---- */

static adcgs_status copy_file(const char *from, const char *to, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_file_load(&data, &bytes, from, PICTURE_BYTES_MAX, error));
    const adcgs_status status = adcgs_atomic_save(to, data, bytes, error);
    free(data);
    return status;
}

static adcgs_status write_shaped(adcgs_import_job *job, const adcgs_source_image *source, adcgs_image *image, const char *from,
                                 const char *to)
{
    ADCGS_TRY(adcgs_photo_shape(image, source->turn, source->width, source->height, from, job->error));
    return adcgs_image_write(image, to, 0, job->error);
}

/** Makes an image from a file. */
static adcgs_status make_picture(adcgs_import_job *job, const adcgs_source_image *source, const char *to)
{
    adcgs_image image;
    if (source->as_is)
        return copy_file(source->path, to, job->error);
    ADCGS_TRY(adcgs_image_read(&image, source->path, job->error));
    const adcgs_status status = write_shaped(job, source, &image, source->path, to);
    adcgs_image_free(&image);
    return status;
}

/** Makes an image from a frame of an open video. */
static adcgs_status make_frame(adcgs_import_job *job, const adcgs_source_image *source, adcgs_video *video, const char *to)
{
    adcgs_image image;
    ADCGS_TRY(adcgs_video_read(video, source->frame, &image, job->error));
    const adcgs_status status = write_shaped(job, source, &image, job->sources.cameras[source->camera].video, to);
    adcgs_image_free(&image);
    return status;
}

/* ---- All images of a camera ---- */

static adcgs_status make_image(adcgs_import_job *job, adcgs_source_image *source, adcgs_video *video)
{
    char *images, *to = NULL;
    ADCGS_TRY(adcgs_import_goes_on(job));
    ADCGS_TRY(adcgs_import_path(&images, job, "images"));
    adcgs_status status = (to = adcgs_source_image_path(&job->sources, source, images))
                              ? ADCGS_OK
                              : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", images);
    free(images);
    if (status == ADCGS_OK && video) {
        source->width = adcgs_video_get_info(video)->width;
        source->height = adcgs_video_get_info(video)->height;
        adcgs_source_image_fit(&source->width, &source->height, job->options->side);
    }
    if (status == ADCGS_OK && !adcgs_is_there(to))
        status = video ? make_frame(job, source, video, to) : make_picture(job, source, to);
    if (status == ADCGS_OK && job->options->masks)
        status = adcgs_import_mask(job, source);
    free(to);
    return status;
}

/** Makes the images of one camera, in the order of its video's frames. */
static adcgs_status make_images(adcgs_import_job *job, uint32_t camera, uint32_t *done)
{
    adcgs_source_images *sources = &job->sources;
    adcgs_video *video = NULL;
    adcgs_status status =
        sources->cameras[camera].video ? adcgs_video_open(&video, sources->cameras[camera].video, job->error) : ADCGS_OK;
    for (uint32_t i = 0; status == ADCGS_OK && i < sources->n; i++) {
        if (sources->list[i].camera != camera)
            continue;
        status = make_image(job, &sources->list[i], video);
        adcgs_import_show(&job->phase, job->progress, "images", ++*done, sources->n, 1.0);
    }
    adcgs_video_close(&video);
    return status;
}

static adcgs_status make_camera_folder(const adcgs_import_job *job, const char *parent, uint32_t camera)
{
    char *name = adcgs_path("%s/%s", parent, job->sources.cameras[camera].folder);
    const adcgs_status status =
        name ? adcgs_import_make_folder(job, name) : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", parent);
    free(name);
    return status;
}

adcgs_status adcgs_import_pictures(adcgs_import_job *job)
{
    uint32_t done = 0;
    ADCGS_TRY(adcgs_import_make_folder(job, "images"));
    if (job->options->masks)
        ADCGS_TRY(adcgs_import_make_folder(job, "masks"));
    for (uint32_t c = 0; c < job->sources.n_cameras; c++) {
        ADCGS_TRY(make_camera_folder(job, "images", c));
        if (job->options->masks)
            ADCGS_TRY(make_camera_folder(job, "masks", c));
        ADCGS_TRY(make_images(job, c, &done));
    }
    if (job->options->masks && !job->has_masks)
        return adcgs_fail(job->error, ADCGS_ERR_DATA,
                          "%s: no mask there has the name of an image or of a camera, such as "
                          "%s.png or %s.png",
                          job->options->masks, job->sources.list[0].stem, job->sources.cameras[0].name);
    job->report->width = job->sources.list[0].width;
    job->report->height = job->sources.list[0].height;
    return ADCGS_OK;
}

/* ---- Videos ---- */

static adcgs_status copy_video(const adcgs_import_job *job, const char *from, const char *to)
{
    char buffer[1 << 16];
    FILE *file;
    adcgs_atomic out;
    ADCGS_TRY(adcgs_file_open(&file, from, job->error));
    adcgs_status status = adcgs_atomic_open(&out, to, job->error);
    for (size_t n = 1; status == ADCGS_OK && n;) {
        n = fread(buffer, 1, sizeof buffer, file);
        fwrite(buffer, 1, n, out.file); /* closing the file reports errors */
        status = adcgs_import_goes_on(job);
    }
    if (status == ADCGS_OK && ferror(file))
        status = adcgs_fail(job->error, ADCGS_ERR_IO, "%s: cannot read: %s", from, strerror(errno));
    fclose(file);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&out, job->error);
    adcgs_atomic_abort(&out);
    return status;
}

adcgs_status adcgs_import_videos(adcgs_import_job *job)
{
    ADCGS_TRY(adcgs_import_make_folder(job, "videos"));
    for (uint32_t i = 0; i < job->sources.n_cameras; i++) {
        const adcgs_source_image_camera *camera = &job->sources.cameras[i];
        char *to = adcgs_path("%s/videos/%s.%s", job->folder, camera->name, adcgs_extension(camera->video));
        adcgs_status status = !to                  ? adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->folder)
                              : adcgs_is_there(to) ? ADCGS_OK
                                                   : copy_video(job, camera->video, to);
        free(to);
        ADCGS_TRY(status);
        if (job->options->masks)
            ADCGS_TRY(adcgs_import_camera_mask(job, i));
        adcgs_import_show(&job->phase, job->progress, "videos", i + 1, job->sources.n_cameras, 1.0);
    }
    return ADCGS_OK;
}
