/* SPDX-License-Identifier: BSD-2-Clause */
/** \file OpenImageIO seen from C. */
#include "config.h"

/* The standard headers first: the shim's own header includes C headers inside extern "C". */
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "io/oiio_shim.h"

namespace {

/** Run work and turn whatever it throws into a status. */
template <typename Work> adcgs_status guarded(const char *path, adcgs_error *error, Work work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    } catch (const std::exception &problem) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %s", path, problem.what());
    } catch (...) {
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: OpenImageIO failed", path);
    }
}

/** The first line of a message, which may quote the file's name again. */
std::string first_line(const std::string &text)
{
    return text.empty() ? "no reason given" : text.substr(0, text.find('\n'));
}

std::string extension_of(const std::string &path)
{
    const size_t slash = path.rfind('/'), dot = path.rfind('.');
    return dot == std::string::npos || (slash != std::string::npos && dot < slash) ? "" : path.substr(dot + 1);
}

/** Whether this build of OpenImageIO knows the extension; its list reads "name:ext,ext;name:ext;...". */
bool knows_extension(const std::string &extension)
{
    std::string list;
    OIIO::getattribute("extension_list", list);
    for (char &c : list)
        if (c == ':' || c == ';')
            c = ',';
    return ("," + list + ",").find("," + extension + ",") != std::string::npos;
}

adcgs_status open_input(std::unique_ptr<OIIO::ImageInput> &input, const char *path, adcgs_error *error)
{
    OIIO::attribute("threads", 1); /* callers have their own threads */
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    input = OIIO::ImageInput::open(path, &hints);
    if (input)
        return ADCGS_OK;
    const std::string reason = first_line(OIIO::geterror());
    const std::string extension = extension_of(path);
    if (!knows_extension(extension))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of OpenImageIO cannot read .%s files", path,
                          extension.c_str());
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: cannot read as an image: %s", path, reason.c_str());
}

/** EXR may hold depth behind its colours. */
int colour_channels(const OIIO::ImageSpec &spec)
{
    return spec.z_channel > 0 && spec.z_channel == spec.nchannels - 1 ? spec.z_channel : spec.nchannels;
}

adcgs_status read(adcgs_image *out, const char *path, adcgs_error *error)
{
    std::unique_ptr<OIIO::ImageInput> input;
    ADCGS_TRY(open_input(input, path, error));
    const OIIO::ImageSpec &spec = input->spec();
    const int channels = colour_channels(spec);
    ADCGS_TRY(adcgs_image_alloc(out, spec.width, spec.height, channels, path, error));
    bool good;
    if (spec.format == OIIO::TypeDesc::UINT8) {
        /* Divided here, so that 8 bits give v/255 to the last bit. */
        std::vector<uint8_t> bytes((size_t)spec.width * (size_t)spec.height * (size_t)channels);
        good = input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, bytes.data());
        for (size_t i = 0; good && i < bytes.size(); i++)
            out->data[i] = (float)bytes[i] / 255.0f;
    } else
        good = input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, out->data);
    if (!good)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: damaged image: %s", path, first_line(input->geterror()).c_str());
    if (spec.alpha_channel >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha"))
        adcgs_image_unpremultiply(out);
    return ADCGS_OK;
}

/** Samples of the kind that the format is to hold. */
template <typename Sample>
bool write_samples(OIIO::ImageOutput &output, const adcgs_image *image, OIIO::TypeDesc kind,
                   void (*convert)(const float *, size_t, Sample *))
{
    std::vector<Sample> samples((size_t)image->width * (size_t)image->height * (size_t)image->channels);
    convert(image->data, samples.size(), samples.data());
    return output.write_image(kind, samples.data()) && output.close();
}

adcgs_status write(const adcgs_image *image, int bits, const char *name, const char *extension, const char *path,
                   adcgs_error *error)
{
    const OIIO::TypeDesc kind = bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
    OIIO::attribute("threads", 1);
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(extension);
    if (!output) {
        OIIO::geterror(); /* take the message away, else the library prints it at exit */
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of OpenImageIO cannot write .%s files", path, extension);
    }
    if (image->channels % 2 == 0 && !output->supports("alpha"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no alpha; EXR, PNG and TIFF do", path, extension);
    OIIO::ImageSpec spec(image->width, image->height, image->channels, kind);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("jpeg:subsampling", "4:4:4");
    if (std::string(output->format_name()) == "jpeg")
        spec.attribute("Compression", "jpeg:95");
    bool good = output->open(name, spec);
    if (good && output->spec().format != kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no samples of %d bits", path, extension, bits);
    if (good)
        good = bits == 16 ? write_samples(*output, image, kind, adcgs_image_to_u16)
                          : write_samples(*output, image, kind, adcgs_image_to_u8);
    if (good)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", path, first_line(output->geterror()).c_str());
}

adcgs_status probe_c(int *width, int *height, int *channels, const char *path, adcgs_error *error) noexcept
{
    return guarded(path, error, [&]() -> adcgs_status {
        std::unique_ptr<OIIO::ImageInput> input;
        ADCGS_TRY(open_input(input, path, error));
        *width = input->spec().width;
        *height = input->spec().height;
        *channels = colour_channels(input->spec());
        return ADCGS_OK;
    });
}

adcgs_status read_c(adcgs_image *out, const char *path, adcgs_error *error) noexcept
{
    *out = adcgs_image{};
    const adcgs_status status = guarded(path, error, [&]() { return read(out, path, error); });
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}

adcgs_status write_c(const adcgs_image *image, int bits, const char *name, const char *extension, const char *path,
                     adcgs_error *error) noexcept
{
    return guarded(path, error, [&]() { return write(image, bits, name, extension, path, error); });
}

} // namespace

extern "C" const adcgs_oiio adcgs_oiio_table = { PACKAGE_VERSION, probe_c, read_c, write_c };
