/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Draco point clouds: see draco_shim.h. */
#include "config.h"

/* Standard headers come first: draco_shim.h includes C headers inside extern "C". */
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include "media/points/draco_shim.h"

namespace
{

/** Values of a point, normalised integers as 0..1; missing components are zero. */
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
        read_values<double>(position, i, out->position[i]);
        if (bytes_per_colour)
            read_values<uint8_t>(colour, i, out->colour[i]);
    }
    return ADCGS_OK;
}

std::unique_ptr<draco::PointCloud> build(const adcgs_points *points)
{
    draco::PointCloudBuilder builder;
    builder.Start(points->n);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (uint32_t i = 0; i < points->n; i++) {
        const double *const x = points->position[i];
        const float value[3] = {static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])};
        builder.SetAttributeValueForPoint(position, draco::PointIndex(i), value);
    }
    if (points->coloured) {
        const int colour = builder.AddAttribute(draco::GeometryAttribute::COLOR, 3, draco::DT_UINT8);
        builder.SetAttributeValuesForAllPoints(colour, points->colour, sizeof *points->colour);
    }
    return builder.Finalize(false);
}

/** Sequential encoding keeps the order of the points; Draco's tree would be smaller but reorders them. */
adcgs_status encode(uint8_t **data, size_t *bytes, const adcgs_points *points, const char *path, adcgs_error *error)
{
    if (!points->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a Draco file holds at least one point", path);
    const std::unique_ptr<draco::PointCloud> cloud = build(points);
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, ADCGS_DRACO_BITS);
    const draco::Status status =
        cloud ? encoder.EncodePointCloudToBuffer(*cloud, &buffer) : draco::Status(draco::Status::DRACO_ERROR, "no point cloud");
    if (!status.ok())
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: cannot encode as Draco: %s", path, status.error_msg());
    *data = static_cast<uint8_t *>(std::malloc(buffer.size()));
    if (!*data)
        throw std::bad_alloc();
    *bytes = buffer.size();
    std::memcpy(*data, buffer.data(), *bytes);
    return ADCGS_OK;
}

adcgs_status parse_c(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error) noexcept
{
    try {
        return parse(out, data, bytes, path, error);
    } catch (const std::bad_alloc &) {
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (...) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged Draco file", path);
    }
}

adcgs_status encode_c(uint8_t **data, size_t *bytes, const adcgs_points *points, const char *path, adcgs_error *error) noexcept
{
    *data = nullptr;
    *bytes = 0;
    try {
        return encode(data, bytes, points, path, error);
    } catch (const std::bad_alloc &) {
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (...) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: cannot encode as Draco", path);
    }
}

} // namespace

extern "C" const adcgs_draco adcgs_draco_table = {PACKAGE_VERSION, parse_c, encode_c};
