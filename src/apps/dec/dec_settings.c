/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The options of adcgs-dec and their combinations. */
#include "config.h"

#include "apps/dec/dec_settings.h"

#include "apps/dec/dec_open.h"
#include "base/cpu_detect.h"
#include "scene/layouts/sound_file.h"
#include "system/numbers.h"

#include <stdlib.h>

#define OFFSET_MAX 1e12 /* of an offset of splats, in world units; chosen by hand, not measured */

/** Options for the target of frames, and its samples. */
static void add_frame_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    static const char *const formats[] = {"y4m", "raw", "null", NULL};
    const adcgs_option table[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &s->output, 0, 0, "TARGET",
         "target of frames: frame%04d.png (.exr .tif .jpg .ppm),\nclip.mp4 (.mov .mkv .webm .avi), clip.y4m, pixels.raw,\n"
         "or - for standard output",
         NULL, NULL},
        {"format", 'f', ADCGS_OPTION_STRING, &s->format, 0, 0, "NAME",
         "y4m, raw, null, an image's or a video's extension\n(default: by the target's name; - is y4m)", formats, NULL},
        {"half", 0, ADCGS_OPTION_FLAG, &s->half, 0, 0, NULL, "16-bit float samples in EXR (the default there)", NULL, NULL},
        {"float", 0, ADCGS_OPTION_FLAG, &s->use_float, 0, 0, NULL, "32-bit float samples in EXR and raw, unrounded", NULL, NULL},
        {"linear", 0, ADCGS_OPTION_FLAG, &s->linear, 0, 0, NULL, "linear light in EXR instead of sRGB's curve", NULL, NULL},
        {"bits", 0, ADCGS_OPTION_INT, &s->bits, 8, 16, "N", "bits of a sample in PNG, TIFF and PPM: 8 or 16", NULL, NULL},
        {"alpha", 0, ADCGS_OPTION_FLAG, &s->alpha, 0, 0, NULL,
         "write alpha and leave out the background: premultiplied in\nEXR, straight in PNG, TIFF and videos", NULL, NULL},
        {"depth", 0, ADCGS_OPTION_FLAG, &s->depth, 0, 0, NULL, "write depth as channel Z of EXR, in world units", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for files of splats. */
static void add_splat_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    static const char *const axes[] = {"keep", "y-up", "z-up", "y-down", NULL}; /* codes of ADCGS_SPLATS_Y_UP... */
    static const char *const offsets[] = {"keep", NULL};
    const adcgs_option table[] = {
        {"splats", 0, ADCGS_OPTION_FILE, &s->splats.target, 0, 0, "FILE",
         "target of splats instead of frames, as .ply, .spz, .glb or .sog:\n"
         "out.ply for one time (default: the first), out%04d.ply for a\nrange of times; all times in one file: .ftgs.ply,\n"
         ".splatv, .splat4d, .4dgs",
         NULL, NULL},
        {"stable", 0, ADCGS_OPTION_FLAG, &s->splats.is_stable, 0, 0, NULL,
         "with --splats time_%05d.ply: row k is the same splat in all files", NULL, NULL},
        {"f-rest", 0, ADCGS_OPTION_INT, &s->splats.style.rest_degree, 1, 3, "DEGREE",
         "with --splats: degree of the zero harmonics in PLY, for programs\nthat require them (default: none)", NULL, NULL},
        {"spz-version", 0, ADCGS_OPTION_INT, &s->splats.style.spz_version, 2, 4, "N",
         "version of SPZ: 2, 3 or 4 (default: 4), for programs that do not\nknow version 4", NULL, NULL},
        {"axes", 0, ADCGS_OPTION_CHOICE, &s->axes, 0, 0, "AXES",
         "axes of the splats: y-up, z-up, y-down, or keep for the stream's\n"
         "(default: y-up in SPZ and GLB, y-down in PLY and SOG)",
         axes, &s->has_axes},
        {"offset", 0, ADCGS_OPTION_STRING, &s->offset_text, 0, 0, "X,Y,Z|keep",
         "offset to subtract from positions, in the stream's axes, or keep\n"
         "for none (default: the place of a scene far from the origin)",
         offsets, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the coding of videos. */
static void add_video_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    static const char *const codecs[] = {"h264", "hevc", "vp9", "av1", "mpeg4", "ffv1", "prores", "qtrle", NULL};
    const adcgs_option table[] = {
        {"codec", 0, ADCGS_OPTION_STRING, &s->video.codec, 0, 0, "NAME",
         "codec of a video: h264, hevc, vp9, av1, ffv1, prores, qtrle or\n"
         "the name of an FFmpeg encoder (default: by the target's name)",
         codecs, NULL},
        {"crf", 0, ADCGS_OPTION_REAL, &s->video.crf, 0, 63, "Q", "constant rate factor of a video: lower is better, and larger",
         NULL, &s->video.has_crf},
        {"bitrate", 0, ADCGS_OPTION_SIZE, &s->video.bit_rate, 1000, 1e10, "BITS",
         "bits per second of a video (8M) instead of a quality", NULL, NULL},
        {"codec-options", 0, ADCGS_OPTION_STRING, &s->video.options, 0, 0, "NAME=VALUE:...",
         "options of FFmpeg for the encoder, and pix_fmt", NULL, NULL},
        {"sound", 0, ADCGS_OPTION_FILE, &s->video.sound, 0, 0, "FILE|SCENE", "sound to put into a video, unchanged", NULL, NULL},
        {"sound-offset", 0, ADCGS_OPTION_SECONDS, &s->sound_offset, -1e6, 1e6, "TIME",
         "time of the stream at which the sound begins (default: 0, or as\nthe scene says)", NULL, &s->has_sound_offset},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for cameras, times and sizes: the shown part. */
static void add_view_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    static const char *const ways[] = {"follow", "orbit", "spiral", "bullet", NULL};
    const adcgs_option table[] = {
        {"beside", 0, ADCGS_OPTION_FILE, &s->beside, 0, 0, "OTHER",
         "other stream, shown to the right through the same cameras at\nthe same times", NULL, NULL},
        {"camera", 'c', ADCGS_OPTION_FILE, &s->request.camera, 0, 0, "WHICH",
         "name or index of a stored camera, follow, orbit, spiral,\n"
         "bullet, or a path (.json, .chan, .usda) (default: follow, else\ncamera 0, or orbit if none is stored)",
         ways, NULL},
        {"cameras", 0, ADCGS_OPTION_FILE, &s->cameras, 0, 0, "PATH",
         "file for the stored cameras, or for the path of --camera, as\nPATH.json, .chan or .usda; nothing else is written", NULL,
         NULL},
        {"rotation-order", 0, ADCGS_OPTION_CHOICE, &s->order, 0, 0, "ORDER",
         "order of the angles in .chan files: xyz (the default), zxy, ...", adcgs_rotation_orders, NULL},
        {"time", 't', ADCGS_OPTION_STRING, &s->times, 0, 0, "T|A:B|N%",
         "one time, or a range at the stream's frame rate, seconds, or\n"
         "the frame at N percent of the stream (default: everything)",
         NULL, NULL},
        {"size", 's', ADCGS_OPTION_PAIR, s->request.size, 1, 16384, "WxH", "size of the frames; pixels keep their shape", NULL,
         NULL},
        {"fit", 0, ADCGS_OPTION_FLAG, &s->fit, 0, 0, NULL,
         "for frames of another shape: show the whole view of the\n"
         "camera, and more on two sides (default with --size)",
         NULL, NULL},
        {"fill", 0, ADCGS_OPTION_FLAG, &s->request.fill, 0, 0, NULL,
         "for frames of another shape: show only the view of the\ncamera, less on two sides", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the used part of the stream, and for checks. */
static void add_decoding_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    const adcgs_option table[] = {
        {"layers", 'L', ADCGS_OPTION_INT, &s->config.layers, 1, 5, "N", "layers of the stream to use, at most", NULL, NULL},
        {.letter = 'l', .kind = ADCGS_OPTION_FORMER, .value = "layers"},
        {"tiers", 0, ADCGS_OPTION_INT, &s->tiers, 1, 8, "N", "tiers of the stream to render; fewer give a coarser image", NULL,
         NULL},
        {"budget", 0, ADCGS_OPTION_STRING, &s->budget_text, 0, 0, "B",
         "limit of the bytes read (40k), or of splats (20000splats) or\n"
         "milliseconds per frame (16ms), which the number of rendered\ntiers meets",
         NULL, NULL},
        {"md5", 0, ADCGS_OPTION_FLAG, &s->md5, 0, 0, NULL,
         "print the MD5 of each frame: its RGB values as little-endian\nbinary32, row by row", NULL, NULL},
        {"verify", 0, ADCGS_OPTION_STRING, &s->verify, 0, 0, "MD5", "MD5 that all frames together must have", NULL, NULL},
        {"answer", 0, ADCGS_OPTION_FILE, &s->answer, 0, 0, "REQUESTS",
         "file of requests for digests to answer, see the\nspecification's clause on conformance", NULL, NULL},
        {"frametimes", 0, ADCGS_OPTION_FLAG, &s->frametimes, 0, 0, NULL,
         "print milliseconds from opening to the first frame, then the\nrender time of each frame", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the window, the machine and damaged streams. */
static void add_program_options(adcgs_option_table *out, adcgs_dec_settings *s)
{
    const adcgs_option table[] = {
        {"play", 0, ADCGS_OPTION_FLAG, &s->play, 0, 0, NULL, "show the stream in a window, with a movable camera", NULL, NULL},
        {"script", 0, ADCGS_OPTION_FILE, &s->script, 0, 0, "COMMANDS", "with --play: file of commands that replace the user's",
         NULL, NULL},
        {"threads", 'T', ADCGS_OPTION_INT, &s->config.threads, 1, 256, "N", "threads (default: one per CPU)", NULL, NULL},
        {"cpu", 0, ADCGS_OPTION_CHOICE, &s->cpu, 0, 0, "LEVEL", "auto, scalar, avx2 or avx512; no effect on the frames",
         adcgs_cpu_names, NULL},
        {"conceal", 0, ADCGS_OPTION_FLAG, &s->config.conceal, 0, 0, NULL,
         "show the intact parts of a damaged file, and report faults", NULL, NULL},
        {"strict", 0, ADCGS_OPTION_FLAG, &s->config.strict_end, 0, 0, NULL, "refuse a stream that ends early", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

void adcgs_dec_options(adcgs_dec_settings *s, adcgs_option_table *options)
{
    add_frame_options(options, s);
    add_splat_options(options, s);
    add_video_options(options, s);
    add_view_options(options, s);
    add_decoding_options(options, s);
    add_program_options(options, s);
}

#define FORMATS "format,half,float,linear,bits,alpha,depth,codec,crf,bitrate,codec-options,sound,beside"

const adcgs_option_rule adcgs_dec_rules[ADCGS_DEC_RULES] = {
    {"tiers", ADCGS_OPTION_EXCLUDES, "play,answer"},
    {"budget", ADCGS_OPTION_EXCLUDES, "tiers,play,answer,conceal,splats,cameras,beside"},
    {"play", ADCGS_OPTION_EXCLUDES, "output," FORMATS ",splats,cameras,md5,verify,answer,frametimes"},
    {"script", ADCGS_OPTION_NEEDS, "play"},
    {"half,float", ADCGS_OPTION_APART, NULL},
    {"answer", ADCGS_OPTION_GOES_WITH, "layers,conceal,strict,threads,cpu"},
    {"splats", ADCGS_OPTION_GOES_WITH, "f-rest,stable,spz-version,axes,offset,time,layers,tiers,conceal,strict,threads,cpu"},
    {"f-rest,stable,spz-version,axes,offset", ADCGS_OPTION_NEEDS, "splats"},
    {FORMATS, ADCGS_OPTION_NEEDS, "output"},
    {"sound-offset", ADCGS_OPTION_NEEDS, "sound"},
    {"crf,bitrate", ADCGS_OPTION_APART, NULL},
    {"fit,fill", ADCGS_OPTION_NEEDS, "size"},
    {"fit,fill", ADCGS_OPTION_APART, NULL},
    {"bits", ADCGS_OPTION_EXCLUDES, "half,float"},
    {"beside", ADCGS_OPTION_EXCLUDES, "alpha,depth,md5,verify,frametimes"},
};

/** Reports a concealed fault. */
static void report_fault(void *user, adcgs_log_level level, const char *text)
{
    const adcgs_dec_settings *s = user;
    if (level == ADCGS_LOG_WARNING)
        adcgs_cli_note(s->cli, "%s: %s", s->input, text);
}

int adcgs_dec_has_style(const adcgs_dec_settings *s)
{
    return s->video.codec || s->video.has_crf || s->video.bit_rate || s->video.options || s->video.sound;
}

/** Parses T, A:B or N%. */
static adcgs_status check_times(adcgs_dec_settings *s, adcgs_error *error)
{
    char *end;
    s->part = -1.0;
    s->request.has_times = s->times != NULL;
    if (!s->times)
        return ADCGS_OK;
    const double percent = strtod(s->times, &end);
    if (end != s->times && !strcmp(end, "%") && percent >= 0.0 && percent <= 100.0)
        s->part = percent / 100.0;
    else if (adcgs_parse_times(s->times, &s->request.begin, &s->request.end))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time %s: expected seconds, A:B with A not after B, or 0%% to 100%%",
                          s->times);
    if (s->play && s->part >= 0.0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time %s: --play takes seconds", s->times);
    return ADCGS_OK;
}

/** Parses the offset, X,Y,Z or keep, and takes over the axes. */
static adcgs_status check_splats(adcgs_dec_settings *s, adcgs_error *error)
{
    char text[128], *rest = text;
    if (s->has_axes)
        s->splats.style.axes = s->axes ? (uint8_t)s->axes : ADCGS_SPLATS_KEEP;
    s->splats.has_offset = s->offset_text != NULL;
    if (!s->offset_text || !strcmp(s->offset_text, "keep"))
        return ADCGS_OK;
    int good = (size_t)snprintf(text, sizeof text, "%s", s->offset_text) < sizeof text;
    for (int a = 0; a < 3 && good; a++) {
        char *const end = rest + strcspn(rest, ",");
        good = (*end == ',') == (a < 2);
        *end = 0;
        good = good && !adcgs_parse_real(rest, -OFFSET_MAX, OFFSET_MAX, &s->splats.offset[a]);
        rest = end + 1;
    }
    return good ? ADCGS_OK
                : adcgs_fail(error, ADCGS_ERR_USAGE, "--offset %s: expected X,Y,Z, each up to 1e12, or keep", s->offset_text);
}

adcgs_status adcgs_dec_check(adcgs_dec_settings *s, adcgs_error *error)
{
    s->config.cpu = (adcgs_cpu_level)s->cpu;
    ADCGS_TRY(check_times(s, error));
    ADCGS_TRY(check_splats(s, error));
    if (s->budget_text)
        ADCGS_TRY(adcgs_budget_parse(&s->budget, s->budget_text, error));
    if (s->config.conceal && !strcmp(s->input, "-"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--conceal needs a file: standard input cannot be read twice");
    if (s->config.conceal) {
        s->config.log = report_fault;
        s->config.log_user = s;
    }
    s->config.on_demand = s->times || s->play; /* a whole clip is read, and checked, as a whole */
    const int frames = s->output || s->request.camera || s->request.size[0] || s->md5 || s->verify || s->frametimes;
    if (s->bits % 8)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--bits %d: expected 8 or 16", s->bits);
    if (!s->output && !s->md5 && !s->verify && !s->frametimes && !s->answer && !s->splats.target && !s->cameras && !s->play)
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "no output: give -o TARGET, --md5, --verify, --frametimes, --splats, --cameras, --answer or --play");
    const int renders = s->output || s->md5 || s->verify || s->frametimes;
    if (s->cameras && (renders || (!s->request.camera && (frames || s->times))))
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "--cameras renders nothing: it goes with --camera only, and with --time and "
                          "--size if --camera is given");
    s->request.order = (adcgs_rotation_order)s->order;
    if (s->output && !strcmp(s->output, "-") && (s->md5 || s->frametimes))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--md5 and --frametimes need standard output, which --output uses");
    if (s->verify && (strlen(s->verify) != 32 || strspn(s->verify, "0123456789abcdefABCDEF") != 32))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--verify %s: expected 32 hexadecimal digits", s->verify);
    return ADCGS_OK;
}

adcgs_status adcgs_dec_find_sound(adcgs_dec_settings *s, adcgs_error *error)
{
#ifdef HAVE_ENCODER
    double begin;
    if (!s->video.sound)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_sound_file_find(&s->sound, &begin, s->video.sound, error));
    if (!s->sound)
        adcgs_cli_note(s->cli, "%s: this scene has no sound", s->video.sound);
    s->video.sound = s->sound;
    s->sound_offset = s->has_sound_offset ? s->sound_offset : begin;
#endif
    return ADCGS_OK;
}
