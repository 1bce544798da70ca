/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Encoding by OpenImageIO: in memory, or in a file in memory for formats that are written to named files only. */
#include "config.h"

/* Standard headers come first: the shim's own header includes C headers inside extern "C". */
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "media/image/oiio_encode.h"

namespace
{

/** Write samples of the format's kind. */
template <typename Sample>
bool write_samples(OIIO::ImageOutput &output, const adcgs_image *image, OIIO::TypeDesc kind,
                   void (*convert)(const float *, size_t, Sample *))
{
    /* Samples that OpenImageIO 2.4 reads behind the last row of an HEIC image: it assumes rows of a multiple of 64 samples. */
    constexpr size_t BEHIND = 64 * 4;
    const size_t n = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    std::vector<Sample> samples(n + BEHIND);
    convert(image->data, n, samples.data());
    return output.write_image(kind, samples.data());
}

/** Open an output under a name, write to it and close it. */
adcgs_status write(OIIO::ImageOutput &output, const adcgs_image *image, int bits, const std::string &name, const char *extension,
                   const char *path, adcgs_error *error)
{
    const OIIO::TypeDesc kind = bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
    OIIO::ImageSpec spec(image->width, image->height, image->channels, kind);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (strcmp(output.format_name(), "tiff") != 0) /* in TIFF it would become EXIF, which is lost in memory; integers are sRGB
                                                      anyway */
        spec.attribute("oiio:ColorSpace", "sRGB");
    bool good = output.open(name, spec);
    if (good && output.spec().format != kind)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no samples of %d bits", path, extension, bits);
    if (good)
        good = bits == 16 ? write_samples(output, image, kind, adcgs_image_to_u16)
                          : write_samples(output, image, kind, adcgs_image_to_u8);
    good = good && output.close();
    if (good)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: %s", path, adcgs_oiio_first_line(output.geterror()).c_str());
}

/** Check by reading the output, since OpenImageIO misses some write errors. */
bool reads_back(const char *extension, const std::string &name, OIIO::Filesystem::IOProxy *proxy, const adcgs_image *image)
{
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(extension);
    OIIO::geterror(); /* else it is printed at exit */
    if (!input || (proxy && !input->supports("ioproxy")))
        return true; /* no reader to check with */
    OIIO::ImageSpec spec;
    bool good = (!proxy || input->set_ioproxy(proxy)) && input->open(name, spec) && spec.width == image->width &&
                spec.height == image->height;
    if (good) {
        std::vector<uint8_t> samples((size_t)spec.width * (size_t)spec.height * (size_t)spec.nchannels);
        good = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, samples.data());
    }
    input->geterror();
    return good;
}

adcgs_status encode_in_memory(std::vector<uint8_t> &out, OIIO::ImageOutput &output, const adcgs_image *image, int bits,
                              const char *extension, const char *path, adcgs_error *error)
{
    OIIO::Filesystem::IOVecOutput writer(out);
    if (!output.set_ioproxy(&writer))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .%s files are not written in memory", path, extension);
    const std::string name = std::string("memory.") + extension;
    ADCGS_TRY(write(output, image, bits, name, extension, path, error));
    OIIO::Filesystem::IOMemReader reader(out.data(), out.size());
    if (reads_back(extension, name, &reader, image))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: OpenImageIO's output cannot be read back", path);
}

#ifdef MFD_CLOEXEC
/** Load the whole file of a descriptor. */
bool load(int fd, std::vector<uint8_t> &out)
{
    struct stat status;
    if (fstat(fd, &status))
        return false;
    out.resize((size_t)status.st_size);
    return pread(fd, out.data(), out.size(), 0) == (ssize_t)out.size();
}

/**
 * Encode formats that OpenImageIO writes to named files only. It misses most write errors there, so the file is one in memory.
 */
adcgs_status encode_in_file(std::vector<uint8_t> &out, OIIO::ImageOutput &output, const adcgs_image *image, int bits,
                            const char *extension, const char *path, adcgs_error *error)
{
    const int fd = memfd_create("adcgs", MFD_CLOEXEC);
    if (fd < 0)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot make a file in memory: %s", path, strerror(errno));
    const std::string name = "/proc/self/fd/" + std::to_string(fd);
    adcgs_status status = write(output, image, bits, name, extension, path, error);
    if (status == ADCGS_OK && !(load(fd, out) && (out.empty() || reads_back(extension, name, nullptr, image))))
        status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write: OpenImageIO's output cannot be read back", path);
    close(fd);
    return status;
}
#else
adcgs_status encode_in_file(std::vector<uint8_t> &, OIIO::ImageOutput &, const adcgs_image *, int, const char *extension,
                            const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this system has no files in memory, which .%s files need", path,
                      extension);
}
#endif

} // namespace

adcgs_status adcgs_oiio_encode(uint8_t **data, size_t *bytes, const adcgs_image *image, int bits, const char *extension,
                               const char *path, adcgs_error *error)
{
    std::vector<uint8_t> memory;
    OIIO::attribute("threads", 1);
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(extension);
    if (!output) {
        OIIO::geterror(); /* fetch the message, else the library prints it at exit */
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of OpenImageIO cannot write .%s files", path, extension);
    }
    if (image->channels % 2 == 0 && !output->supports("alpha"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: .%s files hold no alpha; EXR, PNG and TIFF do", path, extension);
    ADCGS_TRY(
        (output->supports("ioproxy") ? encode_in_memory : encode_in_file)(memory, *output, image, bits, extension, path, error));
    if (memory.empty())
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .%s files hold no images", path, extension);
    *data = static_cast<uint8_t *>(std::malloc(memory.size()));
    if (!*data)
        throw std::bad_alloc();
    *bytes = memory.size();
    std::memcpy(*data, memory.data(), *bytes);
    return ADCGS_OK;
}
