/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Draco point clouds seen from C. No exception and no C++ type crosses this border. */
#include "config.h"

/* The standard headers first: points.h includes C headers inside extern "C". */
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>

#include <draco/compression/decode.h>

#include "io/points.h"

namespace {

/** Values of a point, normalised integers as 0..1; zeros where it has fewer than three. */
template <typename T> void read_values(const draco::PointAttribute *attribute, uint32_t point, T value[3])
{
    value[0] = value[1] = value[2] = 0;
    attribute->ConvertValue<T>(attribute->mapped_index(draco::PointIndex(point)),
                               static_cast<int8_t>(attribute->num_components() < 3 ? attribute->num_components() : 3), value);
}

adcgs_status parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(data), bytes);
    draco::Decoder decoder;
    draco::StatusOr<std::unique_ptr<draco::PointCloud>> result = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!result.ok())
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged Draco file: %s", path, result.status().error_msg());
    const draco::PointCloud &cloud = *result.value();
    const draco::PointAttribute *position = cloud.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    const draco::PointAttribute *colour = cloud.GetNamedAttribute(draco::GeometryAttribute::COLOR);
    if (!position || position->num_components() != 3)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the Draco file has no positions with x, y and z", path);
    ADCGS_TRY(adcgs_points_alloc(out, cloud.num_points(), path, error));
    const bool bytes_per_colour = colour && colour->data_type() == draco::DT_UINT8;
    out->coloured = bytes_per_colour;
    for (uint32_t i = 0; i < out->n; i++) {
        read_values<float>(position, i, out->position[i]);
        if (bytes_per_colour)
            read_values<uint8_t>(colour, i, out->colour[i]);
    }
    return ADCGS_OK;
}

} // namespace

extern "C" adcgs_status adcgs_draco_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path,
                                          adcgs_error *error)
{
    try {
        return parse(out, data, bytes, path, error);
    } catch (const std::bad_alloc &) {
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (...) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged Draco file", path);
    }
}
