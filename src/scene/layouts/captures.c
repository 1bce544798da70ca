/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Captures in formats that are recognised by their fields or files, but not read. */
#include "config.h"

#include "scene/layouts/captures.h"

#include "scene/camera_json.h"
#include "system/paths.h"

#include <stdlib.h>

/* Record3D has the poses of ARKit in one list, and one matrix K for all poses. */
adcgs_status adcgs_capture_refuse(json_t *root, const char *path, adcgs_error *error)
{
    if (!json_is_array(json_object_get(root, "poses")) || !json_is_array(json_object_get(root, "K")))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                      "%s: metadata of a Record3D capture, which is not supported: convert it "
                      "to a folder with transforms.json by nerfstudio's ns-process-data record3d",
                      path);
}

#define TO_TRANSFORMS(how) "convert it to a folder with transforms.json by nerfstudio's ns-process-data " how
#define TO_SPLATS "give its point_cloud/iteration_N/point_cloud.ply"
#define AS_COLMAP "export the cameras as a COLMAP model, or as transforms.json"

/** Files or folders that identify the output of a program. */
static const struct {
    const char *files[2]; /**< the second may be NULL */
    const char *name, *advice;
} captures[] = {
    {{"cfg_args", "point_cloud"}, "the output of 3D Gaussian splatting", TO_SPLATS},
    {{"cameras.json", "point_cloud"}, "the output of 3D Gaussian splatting", TO_SPLATS},
    {{"keyframes/cameras", "keyframes/images"}, "a Polycam capture", TO_TRANSFORMS("polycam")},
    {{"keyframes/corrected_cameras", NULL}, "a Polycam capture", TO_TRANSFORMS("polycam")},
    {{"intri.yml", "extri.yml"}, "an EasyMocap scene", AS_COLMAP},
    {{"annots.npy", NULL}, "a ZJU-MoCap scene", AS_COLMAP},
    {{"cameras_sphere.npz", NULL}, "a scene for IDR or NeuS", AS_COLMAP},
    {{"intrinsics.txt", "pose"}, "an NSVF scene", AS_COLMAP},
};

static adcgs_status refuse_files(const char *folder, adcgs_error *error)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(captures); i++)
        if (adcgs_is_there_at("%s/%s", folder, captures[i].files[0]) &&
            (!captures[i].files[1] || adcgs_is_there_at("%s/%s", folder, captures[i].files[1])))
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %s (it has %s), which is not supported: %s", folder,
                              captures[i].name, captures[i].files[0], captures[i].advice);
    return ADCGS_OK;
}

adcgs_status adcgs_capture_refuse_folder(const char *folder, adcgs_error *error)
{
    static const char *const places[] = {"metadata.json", "metadata", "EXR_RGBD/metadata.json", "EXR_RGBD/metadata"};
    for (size_t i = 0; i < ADCGS_COUNTOF(places); i++) {
        json_t *root = NULL;
        adcgs_error unused;
        if (!adcgs_is_there_at("%s/%s", folder, places[i]))
            continue;
        char *path = adcgs_path("%s/%s", folder, places[i]);
        if (!path)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
        const int is_read = adcgs_json_load(&root, path, &unused) == ADCGS_OK;
        const adcgs_status status = is_read ? adcgs_capture_refuse(root, path, error) : ADCGS_OK;
        json_decref(root);
        free(path);
        ADCGS_TRY(status);
    }
    return refuse_files(folder, error);
}
