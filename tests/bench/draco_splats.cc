/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Visible properties of splats, coded by Draco. Draco's own program supports only positions, normals and colours.
 *
 *     encode IN.ply OUT.drc POSITION_BITS OTHER_BITS
 *     decode IN.drc OUT.ply
 *
 * Colours, opacities, logarithms of the extents and rotations (with w at least 0) are generic attributes. Each is rounded to
 * OTHER_BITS of its own range. Both of Draco's methods for point clouds run at the slowest speed; the smaller result is written.
 */
#include "config.h"

/* The standard headers come first, since later includes are C headers inside extern "C". */
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

extern "C" {
#include "media/splats/splats.h"
}

namespace
{

enum { COLOUR, OPACITY, SCALE, ROTATION, GENERICS };
const int components[GENERICS] = {3, 1, 3, 4};
const int bits_max = 30;

/** Writes the values of a generic attribute of a splat. */
void take(float *out, const adcgs_splats &s, uint32_t i, int attribute)
{
    const float sign = s.rotation[0][i] < 0 ? -1.0f : 1.0f;
    for (int c = 0; c < components[attribute]; c++)
        out[c] = attribute == COLOUR    ? s.colour[c][i]
                 : attribute == OPACITY ? s.opacity[i]
                 : attribute == SCALE   ? std::log(s.scale[c][i])
                                        : sign * s.rotation[c][i];
}

/** The inverse; rounded values become a valid rotation and opacity again. */
void put(adcgs_splats &s, uint32_t i, int attribute, const float *in)
{
    float square = 0;
    for (int c = 0; c < components[attribute]; c++)
        square += in[c] * in[c];
    for (int c = 0; c < components[attribute]; c++)
        if (attribute == COLOUR)
            s.colour[c][i] = in[c];
        else if (attribute == OPACITY)
            s.opacity[i] = std::fmin(std::fmax(in[c], 0.0f), 1.0f);
        else if (attribute == SCALE)
            s.scale[c][i] = std::exp(in[c]);
        else
            s.rotation[c][i] = square > 0 ? in[c] / std::sqrt(square) : c == 0;
}

std::unique_ptr<draco::PointCloud> build(const adcgs_splats &s)
{
    draco::PointCloudBuilder builder;
    builder.Start(s.n);
    std::vector<float> values(3 * static_cast<size_t>(s.n));
    for (size_t i = 0; i < values.size(); i++)
        values[i] = s.mean[i % 3][i / 3];
    builder.SetAttributeValuesForAllPoints(builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
                                           values.data(), 0);
    for (int a = 0; a < GENERICS; a++) {
        const size_t n = static_cast<size_t>(components[a]);
        values.resize(n * s.n);
        for (uint32_t i = 0; i < s.n; i++)
            take(&values[n * i], s, i, a);
        const int id = builder.AddAttribute(draco::GeometryAttribute::GENERIC, static_cast<int8_t>(n), draco::DT_FLOAT32);
        builder.SetAttributeValuesForAllPoints(id, values.data(), 0);
    }
    return builder.Finalize(false);
}

int encode(const char *from, const char *to, int position_bits, int other_bits)
{
    static const int methods[] = {draco::POINT_CLOUD_SEQUENTIAL_ENCODING, draco::POINT_CLOUD_KD_TREE_ENCODING};
    adcgs_splats splats;
    adcgs_error error;
    if (adcgs_splats_read(&splats, from, &error) != ADCGS_OK) {
        std::fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    const std::unique_ptr<draco::PointCloud> cloud = build(splats);
    std::vector<char> least;
    for (const int method : methods) {
        draco::Encoder encoder;
        draco::EncoderBuffer buffer;
        encoder.SetSpeedOptions(0, 0);
        encoder.SetEncodingMethod(method);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, position_bits);
        encoder.SetAttributeQuantization(draco::GeometryAttribute::GENERIC, other_bits);
        const draco::Status status = encoder.EncodePointCloudToBuffer(*cloud, &buffer);
        if (!status.ok())
            std::fprintf(stderr, "%s: %s\n", from, status.error_msg());
        else if (least.empty() || buffer.size() < least.size())
            least.assign(buffer.data(), buffer.data() + buffer.size());
    }
    adcgs_splats_free(&splats);
    std::ofstream file(to, std::ios::binary);
    file.write(least.data(), static_cast<std::streamsize>(least.size()));
    file.close();
    if (least.empty() || !file)
        std::fprintf(stderr, "%s: cannot be written\n", to);
    return least.empty() || !file;
}

/** Decoded attributes have the order of the encoder. */
int write(const draco::PointCloud &cloud, const char *to)
{
    adcgs_splats splats;
    adcgs_error error;
    if (cloud.num_attributes() != 1 + GENERICS) {
        std::fprintf(stderr, "%s: %d attributes, expected %d\n", to, cloud.num_attributes(), 1 + GENERICS);
        return 1;
    }
    const adcgs_splats_style style = {"by Draco", 0, 0, 0};
    adcgs_status status = adcgs_splats_alloc(&splats, cloud.num_points(), to, &error);
    for (uint32_t i = 0; status == ADCGS_OK && i < splats.n; i++)
        for (int a = 0; a <= GENERICS; a++) {
            const draco::PointAttribute *const attribute = cloud.attribute(a);
            float value[4] = {0, 0, 0, 0};
            attribute->GetMappedValue(draco::PointIndex(i), value);
            for (int c = 0; c < 3 && a == 0; c++)
                splats.mean[c][i] = value[c];
            if (a > 0)
                put(splats, i, a - 1, value);
        }
    if (status == ADCGS_OK) {
        status = adcgs_splats_write(&splats, &style, to, &error);
        adcgs_splats_free(&splats);
    }
    if (status != ADCGS_OK)
        std::fprintf(stderr, "%s\n", error.text);
    return status != ADCGS_OK;
}

int decode(const char *from, const char *to)
{
    std::ifstream file(from, std::ios::binary);
    const std::vector<char> data((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(data.data(), data.size());
    draco::StatusOr<std::unique_ptr<draco::PointCloud>> cloud = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!cloud.ok()) {
        std::fprintf(stderr, "%s: %s\n", from, cloud.status().error_msg());
        return 1;
    }
    return write(*cloud.value(), to);
}

} // namespace

int main(int argc, char **argv)
{
    const int position = argc == 6 ? std::atoi(argv[4]) : 0, other = argc == 6 ? std::atoi(argv[5]) : 0;
    if (argc == 6 && !std::strcmp(argv[1], "encode") && position > 0 && position <= bits_max && other > 0 && other <= bits_max)
        return encode(argv[2], argv[3], position, other);
    if (argc == 4 && !std::strcmp(argv[1], "decode"))
        return decode(argv[2], argv[3]);
    std::fprintf(stderr, "expected encode IN.ply OUT.drc POSITION_BITS OTHER_BITS, or decode IN.drc OUT.ply\n");
    return 2;
}
