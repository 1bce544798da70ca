/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kinds of files that begin with bytes of their own. */
#include "media/kind_rows.h"

typedef struct magic {
    uint16_t at, n;
    const char *bytes; /* NULL: an end of the table */
    adcgs_kind kind;
} magic;

#define AT(place, text) place, sizeof text - 1, text

static const magic magics[] = {
    {AT(0, "\x8b"
           "ADC\r\n\x1a\n"),
     {ADCGS_KIND_STREAM, "an adcgs stream", NULL, NULL, 1, 0}},
    /* Images. */
    {AT(0, "\x89PNG\r\n\x1a\n"), IMAGE("a PNG image", "png")},
    {AT(0, "\xff\xd8\xff"), IMAGE("a JPEG image", "jpeg")},
    {AT(8, "WEBP"), IMAGE("a WebP image", "webp")},
    {AT(0, "\x76\x2f\x31\x01"), IMAGE("an OpenEXR image", "openexr")},
    {AT(0, "#?RADIANCE"), IMAGE("a Radiance HDR image", "hdr")},
    {AT(0, "#?RGBE"), IMAGE("a Radiance HDR image", "hdr")},
    {AT(0, "GIF87a"), IMAGE("a GIF image", "gif")},
    {AT(0, "GIF89a"), IMAGE("a GIF image", "gif")},
    {AT(0, "8BPS"), NO_IMAGE("a Photoshop document", TO_PNG)},
    {AT(0, "FUJIFILMCCD-RAW"), NO_IMAGE("a raw image of a camera (RAF)", TO_JPEG)},
    {AT(0, "IIU\0"), NO_IMAGE("a raw image of a camera (RW2)", TO_JPEG)},
    {AT(0, "IIRO"), NO_IMAGE("a raw image of a camera (ORF)", TO_JPEG)},
    {AT(0, "IIRS"), NO_IMAGE("a raw image of a camera (ORF)", TO_JPEG)},
    {AT(0, "MMOR"), NO_IMAGE("a raw image of a camera (ORF)", TO_JPEG)},
    {AT(0, "FOVb"), NO_IMAGE("a raw image of a camera (X3F)", TO_JPEG)},
    {AT(0, "\0\0\0\x0cjP  "), NO_IMAGE("a JPEG 2000 image", TO_PNG)},
    {AT(0, "\xff\x4f\xff\x51"), NO_IMAGE("a JPEG 2000 image", TO_PNG)},
    {AT(0, "\0\0\0\x0cJXL "), NO_IMAGE("a JPEG XL image", TO_PNG)},
    {AT(0, "\xff\x0a"), NO_IMAGE("a JPEG XL image", TO_PNG)},
    {AT(0, "qoif"), NO_IMAGE("a QOI image", TO_PNG)},
    {AT(0, "DDS "), NO_IMAGE("a DirectDraw surface", TO_PNG)},
    {AT(0, "SDPX"), NO_IMAGE("a DPX image", TO_PNG)},
    {AT(0, "XPDS"), NO_IMAGE("a DPX image", TO_PNG)},
    {AT(0, "\x80\x2a\x5f\xd7"), NO_IMAGE("a Cineon image", TO_PNG)},
    {AT(0, "SIMPLE  ="), NO_IMAGE("a FITS image", TO_PNG)},
    {AT(0, "\0\0\x01\0"), NO_IMAGE("an icon", TO_PNG)},
    {AT(0, "\x01\xda"), NO_IMAGE("an SGI image", TO_PNG)},
    {AT(128, "DICM"), NO_IMAGE("a DICOM image", TO_PNG)},
    /* Videos, and texts that name some. */
    {AT(0, "\x1a\x45\xdf\xa3"), VIDEO("a video (Matroska or WebM)")},
    {AT(8, "AVI "), VIDEO("a video (AVI)")},
    {AT(0, "\0\0\x01\xba"), VIDEO("a video (MPEG program stream)")},
    {AT(0, "FLV\x01"), VIDEO("a video (Flash)")},
    {AT(0, "OggS"), VIDEO("a video (Ogg)")},
    {AT(0, "YUV4MPEG2"), VIDEO("a video (YUV4MPEG2)")},
    {AT(0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"), VIDEO("a video (ASF)")},
    {AT(0, "ffconcat version"), OTHER("a playlist (ffconcat)", "give the files that it names")},
    {AT(0, "#EXTM3U"), OTHER("a playlist (M3U, HLS)", "give the files that it names")},
    /* Splats and points. */
    {AT(0, "NGSP"), SPLATS("splats (SPZ)")},
    {AT(0, "glTF"), SPLATS("a glTF binary file (GLB)")},
    {AT(0, "Kg\0\0"), OVER_TIME("splats over time (.splatv)")},
    {AT(0, "\x89"
           "4DGS"),
     OVER_TIME("splats over time (.4dgs)")},
    {AT(0, "SP4D"), OVER_TIME("splats over time (.splat4d)")},
    {AT(0, "DRACO"), POINTS("a Draco file")},
    {AT(0, "\x93NUMPY"), POINTS("an array of NumPy (NPY)")},
    {AT(0, "LASF"), NO_POINTS("a point cloud (LAS or LAZ)", "convert it to PLY first")},
    {AT(0, "ASTM-E57"), NO_POINTS("a point cloud (E57)", "convert it to PLY first")},
    {AT(0, "# .PCD"), NO_POINTS("a point cloud (PCD)", "convert it to PLY first")},
    /* Cameras. */
    {AT(0, "SQLite format 3"), NO_SCENE("a database (SQLite, as COLMAP's database.db)", COLMAP_FOLDER)},
    {AT(0, "# Camera list with"), NO_SCENE("COLMAP's cameras.txt", COLMAP_FOLDER)},
    {AT(0, "# Image list with"), NO_SCENE("COLMAP's images.txt", COLMAP_FOLDER)},
    {AT(0, "# 3D point list with"), NO_SCENE("COLMAP's points3D.txt", COLMAP_FOLDER)},
    {AT(0, "NVM_V3"), NO_SCENE("VisualSFM's model (NVM)", TO_COLMAP)},
    {AT(0, "# Bundle file"), NO_SCENE("Bundler's model", TO_COLMAP)},
    {AT(0, "#name,x,y,"), NO_SCENE("RealityCapture's cameras (CSV)", TO_COLMAP)},
    {AT(0, "%YAML"), NO_SCENE("a YAML file, as OpenCV and EasyMocap write cameras", TO_COLMAP)},
    {AT(0, "#usda"), NO_SCENE("a USD scene", TO_COLMAP)},
    {AT(0, "PXR-USDC"), NO_SCENE("a USD scene", TO_COLMAP)},
    {AT(0, "Kaydara FBX"), OTHER("a scene of polygons (FBX)", NULL)},
    {AT(0, "BLENDER"), OTHER("a Blender file", "render its views, as transforms.json lists them")},
    /* Packed files and the like. */
    {AT(0, "7z\xbc\xaf\x27\x1c"), OTHER("an archive (7z)", "unpack it first")},
    {AT(0, "Rar!"), OTHER("an archive (RAR)", "unpack it first")},
    {AT(257, "ustar"), OTHER("an archive (tar)", "unpack it first")},
    {AT(0, "\x28\xb5\x2f\xfd"), OTHER("a file packed by zstd", "unpack it first")},
    {AT(0, "\xfd"
           "7zXZ"),
     OTHER("a file packed by xz", "unpack it first")},
    {AT(0, "BZh"), OTHER("a file packed by bzip2", "unpack it first")},
    {AT(0, "%PDF"), OTHER("a PDF document", NULL)},
    {AT(0, "\x7f"
           "ELF"),
     OTHER("a program", NULL)},
};

const adcgs_kind *adcgs_kind_by_magic(const uint8_t *begin, size_t n)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(magics); i++)
        if (n >= (size_t)magics[i].at + magics[i].n && !memcmp(begin + magics[i].at, magics[i].bytes, magics[i].n))
            return &magics[i].kind;
    return NULL;
}
