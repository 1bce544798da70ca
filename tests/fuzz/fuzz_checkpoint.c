/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted checkpoints. The first byte selects a checkpoint of a generated run: at its beginning, in its middle, or when values
 * are rounded. After it follow changes of eight bytes each, since no fuzzer would find a whole checkpoint: one byte for the kind
 * of change and the range of places, three for the place, four for the value. A run that accepts the checkpoint continues for
 * some iterations, up to its end. F marks a whole file.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "encode/encode.h"
#include "scene/layouts/open.h"
#include "synthetic/scenes.h"
#include "train/settings.h"
#include "train/trainer.h"

#include <ftw.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/checkpoint", "tests/fuzz/regressions/checkpoint", NULL};

enum { STAGES = 4, ITERATIONS = 40, CHANGES_MOST = 64, GOES_ON = 6 };
static const uint32_t stops[STAGES] = {0, 12, 24, 38};

static adcgs_scene *scene;
static adcgs_train_config config;
static adcgs_buffer saved[STAGES];
static adcgs_trainer *used; /* creating a trainer takes longer than all its tests */
static char folder[] = "/tmp/adcgs-fuzz-XXXXXX";

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

static void clean_up(void)
{
    for (int i = 0; i < STAGES; i++)
        adcgs_buffer_clear(&saved[i]);
    adcgs_trainer_free(&used);
    adcgs_scene_free(&scene);
    nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

static int stop_at(void *user, const adcgs_train_report *r)
{
    return r->iteration >= *(const uint32_t *)user;
}

static void configure(adcgs_train_config *c, adcgs_error *error)
{
    FUZZ_REQUIRE(adcgs_train_preset(c, "draft", error) == ADCGS_OK);
    c->iterations = ITERATIONS;
    c->start_anchors = c->max_anchors = 20;
    c->detail_anchors = 0;
    c->densify_interval = 10;
    c->matching_frames = 0;
    c->params.k = 2;
    c->params.n_fv = 4;
    c->params.n_fg = 4;
    c->params.spans = 1;
    c->params.adaptive_steps = 1;
    c->tiers = 2;
    c->shape.theta_width = c->shape.omega_width = c->shape.varpi_width = c->shape.entropy_width = 4;
}

static adcgs_trainer *make(adcgs_error *error)
{
    adcgs_trainer *t;
    FUZZ_REQUIRE(adcgs_trainer_create(&t, scene, &config, adcgs_cpu_best(), NULL, error) == ADCGS_OK);
    t->quantise = adcgs_encode_quantise_hook;
    return t;
}

/** Makes the scene, whose images stay until the program ends, and the checkpoints of a run on it. */
static void prepare(void)
{
    const adcgs_scenes_options options = {.name = "tiny", .width = 8, .height = 8, .format = "ppm"};
    adcgs_error error = {ADCGS_OK, ""};
    FUZZ_REQUIRE(mkdtemp(folder) && atexit(clean_up) == 0);
    FUZZ_REQUIRE(adcgs_scenes_write(folder, &options, NULL, NULL, NULL, &error) == ADCGS_OK);
    FUZZ_REQUIRE(adcgs_scene_open(&scene, folder, NULL, &error) == ADCGS_OK);
    configure(&config, &error);
    adcgs_trainer *t = make(&error);
    for (int i = 0; i < STAGES; i++) {
        uint32_t stop = stops[i];
        int stopped;
        FUZZ_REQUIRE(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error) == ADCGS_OK);
        adcgs_buffer_init(&saved[i]);
        FUZZ_REQUIRE(adcgs_trainer_store(t, &saved[i], &error) == ADCGS_OK);
    }
    adcgs_trainer_free(&t);
}

/** Applies the changes; returns the new size of the copy. */
static size_t change(uint8_t *copy, size_t size, const uint8_t *data, size_t bytes)
{
    for (int i = 0; i < CHANGES_MOST && bytes >= 8; i++, data += 8, bytes -= 8) {
        const size_t place = adcgs_load_le32(data) >> 8, reach = data[0] & 1 ? ADCGS_MIN(size, 2048) : size;
        if (size < 16)
            break;
        const size_t at = place % (reach - 8);
        switch (data[0] >> 1 & 3) {
        case 0:
            copy[at] = data[4];
            break;
        case 1:
            memcpy(copy + at, data + 4, 4);
            break;
        case 2:
            memset(copy + at, data[4], 8);
            break;
        default:
            size = data[5] == 0 ? at : size;
            break; /* truncate */
        }
    }
    return size;
}

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status == ADCGS_OK || (error->status == status && error->text[0] && !strchr(error->text, '\n')));
}

/** Runs some iterations; at the end of training also writes a stream. */
static void go_on(adcgs_trainer *t)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    int stopped = 1;
    uint32_t stop = t->run.iteration < ITERATIONS - GOES_ON ? t->run.iteration + GOES_ON : ITERATIONS;
    adcgs_status status = adcgs_trainer_run(t, stop_at, &stop, &stopped, &error);
    check(status, &error);
    if (status != ADCGS_OK || stopped)
        return;
    status = adcgs_encode_stream(&stream, t, NULL, 0, &error);
    check(status, &error);
    if (status == ADCGS_OK)
        adcgs_stream_clear(&stream, NULL);
}

static adcgs_status load_file(adcgs_trainer *t, const uint8_t *data, size_t size, adcgs_error *error)
{
    char path[] = "/tmp/adcgs-fuzz-XXXXXX";
    const int file = mkstemp(path);
    FUZZ_REQUIRE(file >= 0 && write(file, data, size) == (ssize_t)size && close(file) == 0);
    const adcgs_status status = adcgs_trainer_load(t, path, error);
    unlink(path);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_error error = {ADCGS_OK, ""};
    if (!scene)
        prepare();
    if (!size)
        return 0;
    if (!used)
        used = make(&error);
    adcgs_trainer *t = used;
    adcgs_status status;
    if (*data == 'F') {
        status = load_file(t, data + 1, size - 1, &error);
    } else {
        const adcgs_buffer *from = &saved[*data % STAGES];
        uint8_t *copy = malloc(from->size);
        FUZZ_REQUIRE(copy != NULL);
        memcpy(copy, from->data, from->size);
        const size_t changed = change(copy, from->size, data + 1, size - 1);
        status = adcgs_trainer_restore(t, copy, changed, &error);
        free(copy);
    }
    check(status, &error);
    if (status == ADCGS_OK)
        go_on(t);
    /* The trainer can be restored again after a run or a failure. */
    FUZZ_REQUIRE(adcgs_trainer_restore(t, saved[0].data, saved[0].size, &error) == ADCGS_OK);
    return 0;
}
