/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of checkpoints: "ADCGSCKP", a digest of the images, the walk over the state, and a CRC-32C of the whole. */
#include "train/state/checkpoint.h"

#include "base/digest.h"
#include "scene/content.h"
#include "system/atomic.h"
#include "system/file.h"
#include "train/exposure/contrast.h"
#include "train/state/checkpoint_walk.h"
#include "train/trial/mechanisms.h"

#include <errno.h>
#include <stdlib.h>

static const char magic[8] = {'A', 'D', 'C', 'G', 'S', 'C', 'K', 'P'};

/** Computes the digest of the images. Their files are read once, on first use. */
static adcgs_status find_content(const adcgs_trainer *trainer, adcgs_error *error)
{
    adcgs_trainer *t = (adcgs_trainer *)(uintptr_t)trainer; /* the digest does not affect the run */
    if (!t->views.has_content)
        ADCGS_TRY(adcgs_scene_content(t->scene, ADCGS_SPLIT_TRAIN, t->views.content, error));
    t->views.has_content = 1;
    return ADCGS_OK;
}

/** Writes a file of the current state or of a snapshot. It allocates no memory, which may be exhausted. */
static adcgs_status save(const adcgs_trainer *t, const adcgs_buffer *snapshot, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    uint8_t crc[4];
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    adcgs_checkpoint_walk w = {.file = atomic.file};
    errno = 0;
    adcgs_checkpoint_visit(&w, (void *)(uintptr_t)magic, sizeof magic);
    adcgs_checkpoint_visit(&w, (void *)(uintptr_t)t->views.content, sizeof t->views.content);
    if (snapshot)
        adcgs_checkpoint_visit(&w, snapshot->data, snapshot->size);
    else
        adcgs_checkpoint_walk_all(&w, t);
    adcgs_store_le32(crc, w.crc);
    adcgs_checkpoint_visit(&w, crc, sizeof crc);
    if (!w.unwritten)
        return adcgs_atomic_commit(&atomic, error);
    const int reason = errno;
    adcgs_atomic_abort(&atomic);
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", path, strerror(reason ? reason : EIO));
}

adcgs_status adcgs_trainer_save(const adcgs_trainer *t, const char *path, adcgs_error *error)
{
    ADCGS_TRY(find_content(t, error));
    return save(t, NULL, path, error);
}

uint32_t adcgs_trainer_rescued(const adcgs_trainer *t)
{
    return !t->run.torn ? t->run.iteration : t->run.snapshot.size && !t->run.snapshot.failed ? t->run.snapshot_at : 0;
}

adcgs_status adcgs_trainer_rescue(const adcgs_trainer *t, const char *path, adcgs_error *error)
{
    if (!adcgs_trainer_rescued(t))
        return adcgs_fail(error, ADCGS_ERR_DATA, "nothing to save: the run is before its first iteration");
    return save(t, t->run.torn ? &t->run.snapshot : NULL, path, error);
}

/** Restores from the contents of a file. */
static adcgs_status restore_file(adcgs_trainer *t, const uint8_t *data, size_t size, adcgs_error *error)
{
    const size_t head = sizeof magic + sizeof t->views.content;
    if (size < head + 4 || memcmp(data, magic, sizeof magic))
        return adcgs_fail(error, ADCGS_ERR_DATA, "not a checkpoint of adcgs-enc");
    if (adcgs_crc32c(0, data, size - 4) != adcgs_load_le32(data + size - 4))
        return adcgs_fail(error, ADCGS_ERR_DATA, "damaged: its checksum does not match");
    static const uint8_t unknown[sizeof t->views.content];
    ADCGS_TRY(adcgs_trainer_restore(t, data + head, size - 4 - head, error));
    adcgs_contrast_record(t);                                  /* the other records follow from request, scene and trials */
    if (!memcmp(data + sizeof magic, unknown, sizeof unknown)) /* a failed run did not read the images */
        return ADCGS_OK;
    ADCGS_TRY(find_content(t, error));
    if (memcmp(data + sizeof magic, t->views.content, sizeof t->views.content))
        return adcgs_fail(error, ADCGS_ERR_DATA, "saved with another scene: the files of the training images have changed");
    return ADCGS_OK;
}

adcgs_status adcgs_trainer_load(adcgs_trainer *t, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t size;
    ADCGS_TRY(adcgs_file_load(&data, &size, path, 1ull << 36, error));
    const adcgs_status status = restore_file(t, data, size, error);
    free(data);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}

/*
 * Bytes before the text of trials: magic, content, format, views, four parts of the scene, previous segment, target; definition
 * of the format.
 */
enum { TRIALS_AT = sizeof magic + 16 + 8 + 8 + 4 * 4 + 16 + 1 + 4 + 8 };

adcgs_status adcgs_checkpoint_dropped(uint8_t dropped[ADCGS_MECHANISMS], const char *path, adcgs_error *error)
{
    char text[ADCGS_TRIALS_TEXT] = "";
    uint64_t format = 0;
    uint8_t *data;
    size_t size;
    ADCGS_TRY(adcgs_file_load(&data, &size, path, 1ull << 36, error));
    if (size > TRIALS_AT + sizeof text)
        memcpy(&format, data + sizeof magic + 16, sizeof format);
    if (format == ADCGS_CHECKPOINT_FORMAT)
        memcpy(text, data + TRIALS_AT, sizeof text);
    text[sizeof text - 1] = '\0';
    free(data);
    for (int m = 0; m < ADCGS_MECHANISMS; m++)
        dropped[m] = (uint8_t)adcgs_mechanism_is_dropped(m, text);
    return ADCGS_OK;
}
