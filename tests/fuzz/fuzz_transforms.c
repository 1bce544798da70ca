/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted scenes as JSON files: cameras, times, splits, names. The only image is a small one. */
#define _GNU_SOURCE

#include "outside_file.h"

#include "scene/layouts/transforms.h"
#include "scene/layouts/transforms_check.h"

#define PICTURE "P5\n24 16\n255\n" /* followed by as many pixels, all black */

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/transforms", "tests/fuzz/regressions/transforms", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64], picture[64];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_transforms said = {0};
    adcgs_scene *scene = calloc(1, sizeof *scene);
    const adcgs_split split = (adcgs_split)(size % (ADCGS_SPLITS + 1));
    FUZZ_REQUIRE(scene && mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.json", folder);
    snprintf(picture, sizeof picture, "%s/a.png", folder);
    write_outside_file(path, data, size);
    const uint8_t pixels[sizeof PICTURE - 1 + 24 * 16] = PICTURE;
    write_outside_file(picture, pixels, sizeof pixels);
    FUZZ_REQUIRE((scene->directory = strdup(folder)));
    adcgs_status status = adcgs_transforms_read(scene, &said, path, split, &error);
    if (status == ADCGS_OK)
        status = adcgs_transforms_check(scene, &said, split == ADCGS_SPLITS, path, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0]));
    unlink(path);
    unlink(picture);
    rmdir(folder);
    free(said.points_path);
    adcgs_scene_free(&scene);
    return 0;
}
