/* SPDX-License-Identifier: BSD-2-Clause */
/** \file C interface to OpenImageIO: reading, photos, and the table of its functions. */
#include "config.h"

/* Standard headers come first: the shim's own header includes C headers inside extern "C". */
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include <strings.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include "media/image/oiio_shim.h"

#include "media/image/oiio_encode.h"

namespace
{

#define CONVERT "convert the image to PNG or JPEG first, for instance by heif-convert"

/** Run work and convert any exception into a status. */
template <typename Work> adcgs_status guarded(const char *path, adcgs_error *error, Work work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (const std::length_error &) { /* its text would name a container of the library */
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (const std::exception &) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: OpenImageIO gave up", path);
    } catch (...) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: OpenImageIO failed", path);
    }
}

/** A reader over our own open file. So neither the file's name nor a name inside it can open another file. */
struct opened {
    std::unique_ptr<OIIO::Filesystem::IOFile> file; /* must outlive the reader */
    std::unique_ptr<OIIO::ImageInput> reader;
};

/** Open by the named reader. ImageInput::open() would try every plug-in of OpenImageIO. */
adcgs_status open_input(opened &in, FILE *file, const char *reader, const char *path, adcgs_error *error)
{
    OIIO::attribute("threads", 1); /* callers have their own threads */
    OIIO::ImageSpec hints, spec;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    in.reader = OIIO::ImageInput::create(reader);
    if (!in.reader) {
        OIIO::geterror(); /* fetch the message, else the library prints it at exit */
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of OpenImageIO has no reader of %s; " CONVERT, path,
                          reader);
    }
    std::string name = path;
    if (in.reader->supports("ioproxy")) {
        in.file.reset(new OIIO::Filesystem::IOFile(file, OIIO::Filesystem::IOProxy::Read));
        in.reader->set_ioproxy(in.file.get());
    } else
        name = "/proc/self/fd/" + std::to_string(fileno(file));
    if (in.reader->open(name, spec, hints))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: cannot read as an image (%s): %s", path, reader,
                      adcgs_oiio_first_line(in.reader->geterror()).c_str());
}

/** Check the size before allocating pixels. */
adcgs_status check_size(const OIIO::ImageSpec &spec, const char *path, adcgs_error *error)
{
    if (spec.width >= 1 && spec.height >= 1 && spec.width <= ADCGS_IMAGE_MAX && spec.height <= ADCGS_IMAGE_MAX)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected 1x1 to %dx%d", path, spec.width, spec.height,
                      ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
}

/** Number of channels without depth, which EXR may hold after its colours. */
int colour_channels(const OIIO::ImageSpec &spec)
{
    return spec.z_channel > 0 && spec.z_channel == spec.nchannels - 1 ? spec.z_channel : spec.nchannels;
}

/** True if two names are equal, ignoring case. */
bool same_name(const std::string &a, const char *b)
{
    return a.size() == strlen(b) && !strncasecmp(a.c_str(), b, a.size());
}

/** True for linear light, as declared by the file or implied by its format (EXR), under any of OpenImageIO's names for it. */
bool is_linear(const OIIO::ImageSpec &spec)
{
    static const char *const names[] = {"Linear",     "scene_linear",     "lin_srgb",
                                        "lin_rec709", "lin_rec709_scene", "lin_rec709_display"};
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    for (const char *name : names)
        if (same_name(space, name))
            return true;
    return false;
}

/** Check EXR's primaries. Those of BT.709 are sRGB's, and the default of EXR. */
adcgs_status check_primaries(const OIIO::ImageSpec &spec, const char *path, adcgs_error *error)
{
    static const float bt709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    float given[8];
    if (!spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), given))
        return ADCGS_OK;
    for (int i = 0; i < 8; i++)
        if (!(std::fabs(given[i] - bt709[i]) < 0.005f))
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: its primaries (chromaticities) are not those of BT.709 and sRGB",
                              path);
    return ADCGS_OK;
}

/** Reject NaN and infinity, which would spoil any training on them. */
adcgs_status check_finite(const adcgs_image *image, const char *path, adcgs_error *error)
{
    const size_t row = (size_t)image->width * (size_t)image->channels, values = row * (size_t)image->height;
    for (size_t i = 0; i < values; i++)
        if (!std::isfinite(image->data[i]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: pixel %zu of row %zu is not a finite number", path,
                              i % row / (size_t)image->channels, i / row);
    return ADCGS_OK;
}

adcgs_status read(adcgs_image *out, FILE *file, const char *reader, const char *path, adcgs_error *error)
{
    opened in;
    ADCGS_TRY(open_input(in, file, reader, path, error));
    OIIO::ImageInput *const input = in.reader.get();
    const OIIO::ImageSpec &spec = input->spec();
    const int channels = colour_channels(spec);
    ADCGS_TRY(check_size(spec, path, error));
    ADCGS_TRY(check_primaries(spec, path, error));
    ADCGS_TRY(adcgs_image_alloc(out, spec.width, spec.height, channels, path, error));
    bool good;
    if (spec.format == OIIO::TypeDesc::UINT8) {
        /* divided here, so that 8 bits give exactly v/255 */
        std::vector<uint8_t> bytes((size_t)spec.width * (size_t)spec.height * (size_t)channels);
        good = input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, bytes.data());
        for (size_t i = 0; good && i < bytes.size(); i++)
            out->data[i] = (float)bytes[i] / 255.0f;
    } else
        good = input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, out->data);
    if (!good)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: %s", path, adcgs_oiio_first_line(input->geterror()).c_str());
    if (spec.alpha_channel >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha"))
        adcgs_image_unpremultiply(out);
    if (is_linear(spec))
        adcgs_image_to_srgb(out);
    return check_finite(out, path, error);
}

/* ---- Photos ---- */

#define FILM_WIDTH 36.0f /* width [mm] of the 35 mm film frame that equivalent focal lengths refer to */

adcgs_status tell(adcgs_photo *photo, FILE *file, const char *reader, const char *path, adcgs_error *error)
{
    opened in;
    ADCGS_TRY(open_input(in, file, reader, path, error));
    const OIIO::ImageSpec &spec = in.reader->spec();
    const int turn = spec.get_int_attribute("Orientation", ADCGS_PHOTO_UPRIGHT);
    photo->turn = turn >= 1 && turn <= 8 ? turn : ADCGS_PHOTO_UPRIGHT;
    const float film = spec.get_float_attribute("Exif:FocalLengthIn35mmFilm");
    const float lens = spec.get_float_attribute("Exif:FocalLength");
    photo->focal = film > 1.0f && film < 10000.0f ? film / FILM_WIDTH : 0.0;
    const std::string make = spec.get_string_attribute("Make"), model = spec.get_string_attribute("Model");
    if (!make.empty() || !model.empty())
        snprintf(photo->camera, sizeof photo->camera, "%.32s %.32s %g", make.c_str(), model.c_str(), lens > 0.0f ? lens : 0.0f);
    return ADCGS_OK;
}

/** Copy the result of an operation on images in the library's own memory. */
adcgs_status take(adcgs_image *image, const OIIO::ImageBuf &from, const char *path, adcgs_error *error)
{
    const OIIO::ImageSpec &spec = from.spec();
    adcgs_image made;
    if (from.has_error())
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s", path, adcgs_oiio_first_line(from.geterror()).c_str());
    ADCGS_TRY(adcgs_image_alloc(&made, spec.width, spec.height, spec.nchannels, path, error));
    const OIIO::ROI all(spec.x, spec.x + spec.width, spec.y, spec.y + spec.height);
    if (!from.get_pixels(all, OIIO::TypeDesc::FLOAT, made.data)) {
        adcgs_image_free(&made);
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s", path, adcgs_oiio_first_line(from.geterror()).c_str());
    }
    adcgs_image_free(image);
    *image = made;
    return ADCGS_OK;
}

/** Turn by EXIF's orientation. The library's own reorient() confuses two of the eight (2.4). */
OIIO::ImageBuf upright(const OIIO::ImageBuf &at, int turn)
{
    using namespace OIIO::ImageBufAlgo;
    switch (turn) {
    case 2:
        return flop(at);
    case 3:
        return rotate180(at);
    case 4:
        return flip(at);
    case 5:
        return transpose(at);
    case 6:
        return rotate90(at);
    case 7:
        return rotate180(transpose(at));
    case 8:
        return rotate270(at);
    default:
        return at;
    }
}

adcgs_status shape(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error)
{
    OIIO::attribute("threads", 1);
    OIIO::ImageBuf at(OIIO::ImageSpec(image->width, image->height, image->channels, OIIO::TypeDesc::FLOAT), image->data);
    if (turn != ADCGS_PHOTO_UPRIGHT)
        at = upright(at, turn);
    if (at.spec().width != width || at.spec().height != height)
        at = OIIO::ImageBufAlgo::resize(at, "", 0.0f, OIIO::ROI(0, width, 0, height, 0, 1, 0, at.nchannels()));
    return take(image, at, path, error);
}

adcgs_status probe_c(int *width, int *height, int *channels, FILE *file, const char *reader, const char *path,
                     adcgs_error *error) noexcept
{
    return guarded(path, error, [&]() -> adcgs_status {
        opened in;
        ADCGS_TRY(open_input(in, file, reader, path, error));
        ADCGS_TRY(check_size(in.reader->spec(), path, error));
        *width = in.reader->spec().width;
        *height = in.reader->spec().height;
        *channels = colour_channels(in.reader->spec());
        return ADCGS_OK;
    });
}

adcgs_status read_c(adcgs_image *out, FILE *file, const char *reader, const char *path, adcgs_error *error) noexcept
{
    *out = adcgs_image{};
    const adcgs_status status = guarded(path, error, [&]() { return read(out, file, reader, path, error); });
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}

adcgs_status encode_c(uint8_t **data, size_t *bytes, const adcgs_image *image, int bits, const char *extension, const char *path,
                      adcgs_error *error) noexcept
{
    *data = nullptr;
    *bytes = 0;
    return guarded(path, error, [&]() { return adcgs_oiio_encode(data, bytes, image, bits, extension, path, error); });
}

adcgs_status tell_c(adcgs_photo *photo, FILE *file, const char *reader, const char *path, adcgs_error *error) noexcept
{
    return guarded(path, error, [&]() { return tell(photo, file, reader, path, error); });
}

adcgs_status shape_c(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error) noexcept
{
    return guarded(path, error, [&]() { return shape(image, turn, width, height, path, error); });
}

} // namespace

extern "C" const adcgs_oiio adcgs_oiio_table = {PACKAGE_VERSION, probe_c, read_c, encode_c, tell_c, shape_c};
