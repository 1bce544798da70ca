/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The kind of a file by its bytes, with functions for kinds that a few bytes do not identify. */
#include "config.h"

#include "media/kind.h"

#include "media/kind_rows.h"
#include "media/splats/splat_look.h"
#include "system/extension.h"

#include <ctype.h>
#include <strings.h>

static const adcgs_kind unknown = {ADCGS_KIND_UNKNOWN, "a file of unknown kind", NULL, NULL, 0, 0};

/** The bytes and names to examine. */
typedef struct look {
    const uint8_t *begin, *tail;
    const char *name, *extension;
    size_t n;
    uint64_t size;
} look;

static int begins(const look *l, size_t at, const char *text)
{
    const size_t n = strlen(text);
    return l->n >= at + n && !memcmp(l->begin + at, text, n);
}

/** True if a text occurs anywhere in the first bytes. */
static int has(const look *l, const char *text)
{
    const size_t n = strlen(text);
    for (size_t i = 0; i + n <= l->n; i++)
        if (l->begin[i] == (uint8_t)*text && !memcmp(l->begin + i, text, n))
            return 1;
    return 0;
}

static int ends_in(const look *l, const char *const *list)
{
    for (; *list; list++)
        if (!strcasecmp(l->extension, *list))
            return 1;
    return 0;
}

/** Container of MPEG-4: the brand after the type of the first box decides. */
static const adcgs_kind *find_in_boxes(const look *l)
{
    static const adcgs_kind video = VIDEO("a video (MP4 or QuickTime)"), heif = IMAGE("an HEIC image", "heif"),
                            avif = IMAGE("an AVIF image", "heif"), raw = NO_IMAGE("a raw image of a camera (CR3)", TO_JPEG),
                            fisheyes = {ADCGS_KIND_VIDEO,
                                        "a video of two fisheyes (Insta360)",
                                        NULL,
                                        "export a flat video of it with the camera's own program",
                                        0,
                                        0};
    static const char *const boxes[] = {"ftyp", "moov", "mdat", "wide", "skip", "free"};
    static const char *const heifs[] = {"heic", "heix", "heim", "heis", "hevc", "hevx", "mif1", "msf1", "miaf"};
    static const char *const insv[] = {"insv", "insp", NULL};
    size_t box = 0;
    while (box < ADCGS_COUNTOF(boxes) && !begins(l, 4, boxes[box]))
        box++;
    if (box == ADCGS_COUNTOF(boxes))
        return NULL;
    if (ends_in(l, insv) || (l->tail && !memcmp(l->tail, "8db42d694ccc418790edff439fe026bf", ADCGS_KIND_TAIL)))
        return &fisheyes;
    if (box || begins(l, 8, "qt  "))
        return &video;
    if (begins(l, 8, "crx "))
        return &raw;
    if (begins(l, 8, "avif") || begins(l, 8, "avis"))
        return &avif;
    for (size_t i = 0; i < ADCGS_COUNTOF(heifs); i++)
        if (begins(l, 8, heifs[i]))
            return has(l, "avif") ? &avif : &heif; /* mif1 is used by both */
    return &video;
}

static uint32_t number(const look *l, size_t at, size_t bytes, int is_big)
{
    uint32_t value = 0;
    for (size_t i = 0; i < bytes && at + bytes <= l->n; i++)
        value = value << 8 | l->begin[at + (is_big ? i : bytes - 1 - i)];
    return value;
}

/** Value of a tag of the first image's directory; -1 if the examined bytes do not contain it. */
static int64_t tiff_tag(const look *l, uint32_t tag, int is_big)
{
    const size_t at = number(l, 4, 4, is_big), entries = number(l, at, 2, is_big);
    for (size_t i = 0; i < entries && at + 2 + 12 * (i + 1) <= l->n; i++) {
        const size_t entry = at + 2 + 12 * i;
        if (number(l, entry, 2, is_big) == tag)
            return number(l, entry + 8, 4, is_big);
    }
    return -1;
}

/** Raw images of cameras are TIFF files whose first image is a reduced one. */
static const adcgs_kind *find_in_tiff(const look *l)
{
    static const adcgs_kind tiff = IMAGE("a TIFF image", "tiff"), dng = NO_IMAGE("a raw image (DNG)", TO_JPEG),
                            raw = NO_IMAGE("a raw image of a camera", TO_JPEG);
    static const char *const ends[] = {"nef", "nrw", "arw", "sr2", "srf", "cr2", "pef", "srw", "3fr",
                                       "fff", "iiq", "rwl", "erf", "dcr", "kdc", "mef", "mos", NULL};
    const int is_big = begins(l, 0, "MM\0") && l->n > 3 && (l->begin[3] == '*' || l->begin[3] == '+');
    if (!is_big && !(begins(l, 0, "II") && l->n > 3 && (l->begin[2] == '*' || l->begin[2] == '+') && !l->begin[3]))
        return NULL;
    if (tiff_tag(l, 50706, is_big) >= 0) /* DNGVersion */
        return &dng;
    if (begins(l, 8, "CR") || tiff_tag(l, 254, is_big) == 1 || ends_in(l, ends)) /* 254: the first image is a reduced one */
        return &raw;
    return &tiff;
}

static const adcgs_kind *find_bitmap(const look *l)
{
    static const adcgs_kind bmp = IMAGE("a BMP image", "bmp"), text = IMAGE("a PBM, PGM, PPM or PFM image", "pnm");
    const uint32_t header = number(l, 14, 4, 0);
    if (begins(l, 0, "BM") && l->n >= 26 && !number(l, 6, 4, 0) && header >= 12 && header <= 124)
        return &bmp;
    if (l->n >= 3 && l->begin[0] == 'P' && strchr("123456Ff", l->begin[1]) && l->begin[1] && isspace(l->begin[2]))
        return &text;
    return NULL;
}

/** Archives: the names of their files decide. */
static const adcgs_kind *find_in_archive(const look *l)
{
    static const adcgs_kind sog = SPLATS("splats (SOG)"), tsog = OVER_TIME("splats over time (TSOG)"),
                            d3dg = OVER_TIME("splats over time (params.npz of Dynamic 3D Gaussians)"),
                            npz = OTHER("arrays of NumPy (NPZ)", NULL), zip = OTHER("an archive (ZIP)", "unpack it first");
    static const char *const names[] = {"means_l.webp", "means_u.webp", "scales.webp", "quats.webp",
                                        "sh0.webp",     "shN_",         "meta.json"};
    size_t i = 0;
    if (!begins(l, 0, "PK\3\4") && !begins(l, 0, "PK\5\6"))
        return NULL;
    while (i < ADCGS_COUNTOF(names) && !has(l, names[i]))
        i++;
    if (i < ADCGS_COUNTOF(names))
        return !strcasecmp(l->extension, "tsog") || has(l, "tsog-playback") || has(l, "timeline") ? &tsog : &sog;
    if (has(l, "means3D.npy") || has(l, "rgb_colors.npy") || has(l, "unnorm_rotations.npy"))
        return &d3dg;
    return has(l, ".npy") ? &npz : &zip;
}

static const adcgs_kind *find_ply(const look *l)
{
    static const adcgs_kind plain = SPLATS("splats (PLY)"), other = SPLATS("a PLY file"),
                            stg = OVER_TIME("splats over time (SpacetimeGaussians PLY)"),
                            ftgs = OVER_TIME("splats over time (FTGS PLY)");
    if (!begins(l, 0, "ply\n") && !begins(l, 0, "ply\r"))
        return NULL;
    if (has(l, " trbf_center") || has(l, " log_duration") || has(l, " ftgs_version"))
        return has(l, " trbf_center") ? &stg : &ftgs;
    return has(l, " f_dc_0") || has(l, " packed_position") ? &plain : &other; /* the reader parses the header */
}

/** Formats of splats without a magic number. */
static const adcgs_kind *find_splats(const look *l)
{
    static const adcgs_kind ksplat = SPLATS("splats (.ksplat)"), meta = SPLATS("splats (meta.json of SOG)");
    return adcgs_ksplat_is(l->begin, l->n, l->size) ? &ksplat : adcgs_sog_meta_is(l->begin, l->n) ? &meta : NULL;
}

static const adcgs_kind *find_dot_splat(const look *l)
{
    static const adcgs_kind splat = SPLATS("splats (.splat)");
    return adcgs_dot_splat_is(l->begin, l->n, l->size) ? &splat : NULL;
}

static size_t skip_blanks(const look *l)
{
    size_t at = begins(l, 0, "\xef\xbb\xbf") ? 3 : 0;
    while (at < l->n && isspace(l->begin[at]))
        at++;
    return at;
}

#define RECORD3D NO_SCENE("Record3D's metadata.json", "export it for nerfstudio: ns-process-data record3d")

/** Camera files of other tools. Scenes pass, and so do texts with "frames". */
static const adcgs_kind *find_json(const look *l)
{
    static const struct {
        const char *keys[3];
        adcgs_kind kind;
    } texts[] = {
        {{"\"poses\"", "\"K\"", NULL}, RECORD3D},
        {{"\"poses\"", "\"perFrameIntrinsicCoeffs\"", NULL}, RECORD3D},
        {{"{\"poses\"", NULL, NULL}, RECORD3D},
        {{"\"img_name\"", "\"position\"", "\"rotation\""},
         NO_SCENE("cameras.json as 3D Gaussian splatting writes it", "give the folder of the scene that it was trained on")},
        {{"\"sfm_data_version\"", NULL, NULL}, NO_SCENE("OpenMVG's sfm_data.json", TO_COLMAP)},
        {{"\"featuresFolders\"", NULL, NULL}, NO_SCENE("Meshroom's cameras (SfM)", TO_COLMAP)},
        {{"\"reference_lla\"", NULL, NULL}, NO_SCENE("OpenSfM's reconstruction.json", TO_COLMAP)},
        {{"\"asset\"", "\"version\"", "\"accessors\""}, NO_SPLATS("a glTF text", "pack it as one binary file (GLB)")},
    };
    static const adcgs_kind scene = {ADCGS_KIND_SCENE, "the cameras of a scene (JSON)", NULL, NULL, 1, 0};
    const size_t at = skip_blanks(l);
    if (at >= l->n || (l->begin[at] != '{' && l->begin[at] != '['))
        return NULL;
    if (has(l, "\"adcgs_scene\"") || has(l, "\"transform_matrix\"") || (has(l, "\"w2c\"") && has(l, "\"fn\"")))
        return &scene;
    if (has(l, "\"frames\""))
        return NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(texts); i++) {
        int all = 1;
        for (int k = 0; k < 3 && texts[i].keys[k]; k++)
            all &= has(l, texts[i].keys[k]);
        if (all)
            return &texts[i].kind;
    }
    return NULL;
}

static const adcgs_kind *find_markup(const look *l)
{
    static const adcgs_kind page = {ADCGS_KIND_PAGE,
                                    "a page of adcgs-share",
                                    NULL,
                                    "adcgs-dec renders its stream, adcgs-info describes it",
                                    0,
                                    0},
                            html = {ADCGS_KIND_PAGE, "a page (HTML)", NULL, "save the file that it links to", 0, 0},
                            agisoft = NO_SCENE("Agisoft Metashape's cameras (XML)", TO_COLMAP),
                            blocks = NO_SCENE("cameras as BlocksExchange (XML)", TO_COLMAP), xml = OTHER("an XML text", NULL);
    static const char head[] = "<!doctype html", root[] = "<html";
    const char *const at = (const char *)l->begin + skip_blanks(l);
    const size_t left = l->n - skip_blanks(l);
    if (left < 5 || *at != '<')
        return NULL;
    if ((left >= sizeof head && !strncasecmp(at, head, sizeof head - 1)) || !strncasecmp(at, root, sizeof root - 1))
        return has(l, "<!-- SPDX-License-Identifier: BSD-2-Clause -->") ? &page : &html;
    if (has(l, "<BlocksExchange"))
        return &blocks;
    if (has(l, "<document version") && has(l, "<chunk"))
        return &agisoft;
    return !strncmp(at, "<?xml", 5) ? &xml : NULL;
}

/** Packets of 188 bytes that begin with the same byte. */
static const adcgs_kind *find_transport(const look *l)
{
    static const adcgs_kind video = VIDEO("a video (MPEG transport stream)");
    return l->n > 2 * 188 && l->begin[0] == 'G' && l->begin[188] == 'G' && l->begin[2 * 188] == 'G' ? &video : NULL;
}

/** Two first lines of printable characters with equally many commas. */
static const adcgs_kind *find_table(const look *l)
{
    static const adcgs_kind table = OTHER("a table (CSV)", NULL);
    size_t commas[2] = {0, 0}, line = 0;
    for (size_t i = 0; i < l->n && line < 2; i++) {
        const uint8_t c = l->begin[i];
        if ((c < ' ' && c != '\t' && c != '\r' && c != '\n') || c == 0x7f || c == '{')
            return NULL;
        commas[line] += c == ',';
        line += c == '\n';
    }
    return line == 2 && commas[0] >= 2 && commas[1] == commas[0] ? &table : NULL;
}

static const adcgs_kind *find_packed(const look *l)
{
    static const adcgs_kind spz = SPLATS("splats (SPZ), or another file packed by gzip");
    return begins(l, 0, "\x1f\x8b") ? &spz : NULL;
}

const adcgs_kind *adcgs_kind_of(const uint8_t *begin, size_t n, uint64_t size, const uint8_t *tail, const char *name)
{
    static const adcgs_kind *(*const finders[])(const look *) = {
        find_in_boxes, find_in_tiff, find_bitmap,    find_in_archive, find_ply,       find_packed,
        find_splats,   find_markup,  find_transport, find_json,       find_dot_splat, find_table,
    };
    const look l = {begin, tail, name, adcgs_extension(name), n, size};
    const adcgs_kind *const plain = adcgs_kind_by_magic(begin, n);
    if (plain)
        return plain;
    for (size_t i = 0; i < ADCGS_COUNTOF(finders); i++) {
        const adcgs_kind *const kind = finders[i](&l);
        if (kind)
            return kind;
    }
    return &unknown;
}
