/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Untrusted images and point clouds, detected by content: PGM and PPM with the project's own code; PNG and JPEG through
 * libraries, with the project's error handling; NPY and PLY. Large inputs are only probed: running out of memory is no fault.
 */
#define _GNU_SOURCE

#include "outside_file.h"

#include "media/image/image.h"
#include "media/image/panorama.h"
#include "media/points/points.h"

#include <math.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/pictures", "tests/fuzz/seeds/ply", "tests/fuzz/regressions/pictures",
                                        NULL};

enum { PIXELS_MOST = 1 << 20 };

static void check(adcgs_status status, const adcgs_error *error)
{
    FUZZ_REQUIRE(status == ADCGS_OK || (error->status == status && error->text[0] && !strchr(error->text, '\n')));
}

static void read_image(const char *path)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_image image;
    int width = 0, height = 0, channels = 0;
    adcgs_status status = adcgs_image_probe(&width, &height, &channels, path, &error);
    check(status, &error);
    if (status != ADCGS_OK || (int64_t)width * height > PIXELS_MOST)
        return;
    FUZZ_REQUIRE(width > 0 && height > 0 && width <= ADCGS_IMAGE_MAX && height <= ADCGS_IMAGE_MAX);
    status = adcgs_image_read(&image, path, &error);
    check(status, &error);
    if (status != ADCGS_OK)
        return;
    FUZZ_REQUIRE(image.width == width && image.height == height && image.channels >= 1 && image.channels <= 4);
    const size_t n = (size_t)width * (size_t)height * (size_t)image.channels;
    for (size_t i = 0; i < n; i++)
        FUZZ_REQUIRE(isfinite(image.data[i]));
    adcgs_image_free(&image);
}

static void read_projection(const uint8_t *data, size_t size)
{
    char projection[ADCGS_PANORAMA_NAME];
    adcgs_panorama_find(projection, data, size);
    FUZZ_REQUIRE(strlen(projection) < sizeof projection);
}

static void read_points(const char *path)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_points points;
    const adcgs_status status = adcgs_points_read(&points, path, &error);
    check(status, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (points.n == 0 && points.position == NULL));
    for (uint32_t i = 0; i < points.n; i++)
        for (int a = 0; a < 3; a++)
            FUZZ_REQUIRE(isfinite(points.position[i][a]));
    adcgs_points_free(&points);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64];
    FUZZ_REQUIRE(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/file", folder);
    write_outside_file(path, data, size);
    read_image(path);
    read_projection(data, size);
    if (size < 5 || memcmp(data, "DRACO", 5) != 0) /* Draco files are read by a library */
        read_points(path);
    unlink(path);
    rmdir(folder);
    return 0;
}
