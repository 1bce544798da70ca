/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted scenes in the layout of HyperNeRF: dataset.json, metadata.json, scene.json, the camera of the image a and points.npy,
 * in this order, each of the first four ended by a zero byte. The only image is empty.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "scene/layouts/hypernerf.h"

#include <sys/stat.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/hypernerf", "tests/fuzz/regressions/hypernerf", NULL};

static const char *const folders[] = {"camera", "rgb", "rgb/1x"};
static const char *const files[] = {
    "dataset.json", "metadata.json", "scene.json", "camera/a.json", "points.npy", "rgb/1x/a.png",
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_scene *scene = calloc(1, sizeof *scene);
    FUZZ_REQUIRE(scene && mkdtemp(folder) && (scene->directory = strdup(folder)));
    for (size_t i = 0; i < ADCGS_COUNTOF(folders); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, folders[i]);
        FUZZ_REQUIRE(mkdir(path, 0700) == 0);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(files); i++) {
        const uint8_t *end = i < 4 && size ? memchr(data, 0, size) : NULL;
        const size_t bytes = end ? (size_t)(end - data) : size, skip = bytes + (end != NULL);
        snprintf(path, sizeof path, "%s/%s", folder, files[i]);
        write_outside_file(path, data, bytes);
        data += skip;
        size -= skip;
    }
    const adcgs_status status = adcgs_hypernerf_read(scene, 1, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    for (size_t i = 0; i < ADCGS_COUNTOF(files); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, files[i]);
        unlink(path);
    }
    for (size_t i = ADCGS_COUNTOF(folders); i > 0; i--) {
        snprintf(path, sizeof path, "%s/%s", folder, folders[i - 1]);
        rmdir(path);
    }
    rmdir(folder);
    adcgs_scene_free(&scene);
    return 0;
}
