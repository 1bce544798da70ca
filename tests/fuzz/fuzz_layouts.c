/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted scenes of LLFF and COLMAP, scene files and splats. The first byte selects the kind: L poses_bounds.npy, B a binary
 * model of COLMAP, T the same in text, M two of these, S a scene file, G splats as a scene, P the layout of Dynamic 3D Gaussians.
 * The files follow one after the other; each except the last has its length in two bytes in front. All kinds share two small
 * images.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "scene/layouts/open.h"
#include "scene/scene.h"

#include <sys/stat.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/layouts", "tests/fuzz/regressions/layouts", NULL};

#define PICTURE "P5\n24 16\n255\n" /* followed by as many pixels, all black */

/** The files of each kind; the images come last. */
static const struct kind {
    char letter;
    const char *scene; /* "" for the folder */
    const char *files[5];
    int n;
} kinds[] = {
    {'L', "", {"poses_bounds.npy"}, 1},
    {'B', "", {"cameras.bin", "images.bin", "points3D.bin"}, 3},
    {'T', "", {"cameras.txt", "images.txt", "points3D.txt"}, 3},
    {'S', "/s.json", {"s.json"}, 1},
    {'G', "/s.ply", {"s.ply"}, 1},
    {'M', "", {"cameras.txt", "images.txt", "sparse/1/cameras.txt", "sparse/1/images.txt", "sparse/1/points3D.txt"}, 5},
    {'P', "", {"train_meta.json", "test_meta.json", "init_pt_cld.npz"}, 3},
};
static const char *const pictures[] = {"images/0.ppm", "images/1.ppm", "ims/0.ppm", "ims/1.ppm"};
static const char *const folders[] = {"images", "ims", "sparse", "sparse/1"};

static void put_files(const char *folder, const struct kind *kind, const uint8_t *data, size_t size)
{
    char path[96];
    for (int i = 0; i < kind->n; i++) {
        size_t bytes = size;
        if (i < kind->n - 1) {
            bytes = size < 2 ? 0 : ADCGS_MIN(adcgs_load_le16(data), size - 2);
            data += ADCGS_MIN(size, 2);
            size -= ADCGS_MIN(size, 2);
        }
        snprintf(path, sizeof path, "%s/%s", folder, kind->files[i]);
        write_outside_file(path, data, bytes);
        data += bytes;
        size -= bytes;
    }
}

static void remove_files(const char *folder, const struct kind *kind)
{
    char path[96];
    for (int i = 0; i < kind->n + (int)ADCGS_COUNTOF(pictures); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, i < kind->n ? kind->files[i] : pictures[i - kind->n]);
        unlink(path);
    }
    for (size_t i = ADCGS_COUNTOF(folders); i-- > 0;) {
        snprintf(path, sizeof path, "%s/%s", folder, folders[i]);
        rmdir(path);
    }
    rmdir(folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[96];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_scene *scene;
    const struct kind *kind = &kinds[0];
    for (size_t i = 0; size && i < ADCGS_COUNTOF(kinds); i++)
        kind = kinds[i].letter == *data ? &kinds[i] : kind;
    uint8_t picture[sizeof PICTURE - 1 + 24 * 16] = PICTURE;
    FUZZ_REQUIRE(mkdtemp(folder));
    for (size_t i = 0; i < ADCGS_COUNTOF(folders); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, folders[i]);
        FUZZ_REQUIRE(mkdir(path, 0700) == 0);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(pictures); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, pictures[i]);
        write_outside_file(path, picture, sizeof picture);
    }
    put_files(folder, kind, data + (size > 0), size - (size > 0));
    snprintf(path, sizeof path, "%s%s", folder, kind->scene);
    const adcgs_status status = adcgs_scene_open(&scene, path, NULL, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    adcgs_scene_free(&scene);
    remove_files(folder, kind);
    return 0;
}
