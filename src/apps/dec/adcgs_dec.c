/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec: decodes a stream and renders frames from it. */
#include "config.h"

#include "api/frame_samples.h"
#include "apps/dec/dec_budget.h"
#include "apps/dec/dec_live.h"
#include "apps/dec/dec_open.h"
#include "apps/dec/dec_play.h"
#include "apps/dec/dec_settings.h"
#include "apps/dec/dec_splats.h"
#include "apps/shared/answer.h"
#include "apps/shared/canvas.h"
#include "camera/path.h"
#include "cli/cli.h"
#include "media/sink.h"
#include "system/interrupt.h"
#include "system/text.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <strings.h>

#define SOUND_SLACK 0.02 /* seconds between the sound and the last frame, at most; chosen by hand, not measured */

typedef adcgs_dec_settings settings;

static adcgs_status open_input(adcgs_decoder **decoder, adcgs_operand *source, const char *input, const settings *s,
                               adcgs_error *error)
{
    const adcgs_dec_open_config how = {.cli = s->cli, .budget = &s->budget, .config = &s->config};
    ADCGS_TRY(adcgs_dec_open(decoder, source, input, &how, error));
    return adcgs_set_tiers(*decoder, s->tiers, error);
}

static void print_row(const settings *s, const char *hex, double seconds)
{
    if (s->md5 && s->frametimes)
        printf("%s %.3f\n", hex, 1e3 * seconds);
    else if (s->md5)
        printf("%s\n", hex);
    else if (s->frametimes)
        printf("%.3f\n", 1e3 * seconds);
}

/** The stream to show, and the one next to it or NULL. */
typedef struct streams {
    adcgs_decoder *decoder, *beside;
    adcgs_live *live; /**< source of the decoder's bytes during rendering; NULL: all bytes are present */
} streams;

/** Finishes a rendered frame and passes the image to the sink. */
static adcgs_status write_frame(const streams *from, const adcgs_camera_frame *frame, adcgs_sink *sink, adcgs_canvas *canvas,
                                int index, adcgs_error *error)
{
    ADCGS_TRY(adcgs_canvas_finish(canvas, from->decoder, from->beside, frame, error));
    return adcgs_sink_write_with(sink, &canvas->shown, &canvas->extras, index, error);
}

/** Renders all frames with the tiers that the budget allows for the first frame. */
static adcgs_status fit_budget(const settings *s, const streams *from, const adcgs_camera_path *frames, adcgs_canvas *canvas,
                               adcgs_error *error)
{
    int tiers;
    const adcgs_camera_frame *first = &frames->frame[0];
    ADCGS_TRY(adcgs_budget_fit(&s->budget, from->decoder, &first->camera, first->time, &canvas->frame, &tiers, error));
    if (tiers)
        adcgs_cli_note(s->cli, "%s: %s allows %d tier%s", s->input, s->budget_text, tiers, tiers == 1 ? "" : "s");
    return ADCGS_OK;
}

/** Finds the frames; prints remarks on them when the whole stream is present. */
static adcgs_status make_frames(const settings *s, const streams *from, adcgs_camera_path *frames, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(from->decoder, &info, sizeof info, error));
    if (info.truncated)
        adcgs_cli_note(s->cli, "%s: the stream ends early; showing its complete part", s->input);
    ADCGS_TRY(adcgs_camera_path_make(frames, from->decoder, &s->request, error));
    if (frames->outside && (!from->live || from->live->over))
        adcgs_cli_note(s->cli, "%s: %d of %d frame%s %s its first or last frame: the stream lasts from %g to %g s", s->input,
                       frames->outside, frames->n, adcgs_s((uint64_t)frames->n), frames->outside == 1 ? "shows" : "show",
                       info.time_start, info.time_end);
    return ADCGS_OK;
}

/** Waits until a frame is final, or until it is known whether it exists. */
static adcgs_status await_frame(const settings *s, const streams *from, adcgs_camera_path *frames, int index, adcgs_error *error)
{
    if (!from->live || from->live->over)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_live_wait(from->live, index < frames->n ? frames->frame[index].time : INFINITY, error));
    if (!from->live->over)
        return ADCGS_OK;
    adcgs_camera_path_free(frames); /* a stream may be shorter than its header says */
    return make_frames(s, from, frames, error);
}

/** Renders all frames; *all receives the digest over all frames. */
static adcgs_status render(const settings *s, const streams *from, adcgs_camera_path *frames, adcgs_sink *sink,
                           adcgs_canvas *canvas, adcgs_md5 *all, double *render_seconds, adcgs_error *error)
{
    adcgs_frame *frame = &canvas->frame;
    adcgs_progress progress;
    adcgs_progress_init(&progress, s->cli);
    adcgs_status status = fit_budget(s, from, frames, canvas, error);
    for (int i = 0; status == ADCGS_OK && !adcgs_interrupted(); i++) {
        status = await_frame(s, from, frames, i, error);
        if (status != ADCGS_OK || adcgs_interrupted() || i >= frames->n)
            break;
        const double start = adcgs_seconds();
        status = adcgs_render(from->decoder, &frames->frame[i].camera, frames->frame[i].time, frame, error);
        status = adcgs_camera_path_rendered(&frames->frame[i].camera, status, error);
        const double seconds = adcgs_seconds() - start;
        *render_seconds += seconds;
        if (status == ADCGS_OK && s->frametimes && i == 0)
            printf("first %.3f\n", 1e3 * (start + seconds - s->opened));
        char hex[33] = "";
        if (status == ADCGS_OK && s->md5) {
            uint8_t digest[16];
            adcgs_frame_digest(frame, digest);
            adcgs_md5_hex(digest, hex);
        }
        if (status == ADCGS_OK && s->verify)
            adcgs_frame_digest_add(all, frame);
        if (status == ADCGS_OK && sink)
            status = write_frame(from, &frames->frame[i], sink, canvas, i, error);
        if (status == ADCGS_OK)
            print_row(s, hex, seconds);
        adcgs_progress_show(&progress, "frame %d of %d, %.1f ms", i + 1, frames->n, 1e3 * seconds);
    }
    adcgs_progress_clear(&progress);
    return status;
}

/** The style of the video, with the sound at the first frame's time. Frames must play at the speed of the scene. */
static adcgs_status place_sound(adcgs_video_style *style, const settings *s, const adcgs_camera_path *frames, adcgs_error *error)
{
    const double begin = frames->frame[0].time, last = frames->frame[frames->n - 1].time;
    *style = s->video;
    style->sound_start = begin - s->sound_offset;
    if (s->video.sound && fabs(last - begin - (frames->n - 1) / frames->frame_rate) > SOUND_SLACK)
        return adcgs_fail(
            error, ADCGS_ERR_USAGE,
            "--sound: %d frames show %g s of the scene, and play for %g s: expected a path at the speed of the scene", frames->n,
            last - begin, (frames->n - 1) / frames->frame_rate);
    return ADCGS_OK;
}

static adcgs_status open_sink(adcgs_sink **sink, const settings *s, const adcgs_camera_path *frames, const adcgs_canvas *canvas,
                              adcgs_error *error)
{
    adcgs_video_style style;
    ADCGS_TRY(place_sound(&style, s, frames, error));
    const adcgs_sink_config config = {.target = s->output,
                                      .format = s->format,
                                      .depth = s->use_float    ? ADCGS_DEPTH_FLOAT
                                               : s->half       ? ADCGS_DEPTH_HALF
                                               : s->bits == 16 ? ADCGS_DEPTH_16
                                                               : ADCGS_DEPTH_DEFAULT,
                                      .linear = s->linear,
                                      .frame_rate = frames->frame_rate,
                                      .width = canvas->shown.width,
                                      .height = canvas->shown.height,
                                      .frames = frames->n,
                                      .has_alpha = s->alpha,
                                      .video = adcgs_dec_has_style(s) ? &style : NULL,
                                      .has_z = s->depth};
    return s->output ? adcgs_sink_open(sink, &config, error) : ADCGS_OK;
}

static void note_size(const adcgs_cli *cli, const settings *s, const adcgs_sink *sink, const adcgs_frame *frame)
{
    int width, height;
    adcgs_sink_size(sink, &width, &height);
    if (width != frame->width || height != frame->height)
        adcgs_cli_note(cli, "%s: stored as %dx%d pixels, since its codec takes even sizes only: the edge is repeated", s->output,
                       width, height);
}

/** \return ADCGS_OK; *mismatch is set if the digest is not the expected one. */
static adcgs_status decode(const adcgs_cli *cli, const settings *s, const streams *from, int *mismatch, adcgs_error *error)
{
    adcgs_info info;
    adcgs_camera_path frames;
    adcgs_canvas canvas;
    adcgs_sink *sink = NULL;
    adcgs_md5 all;
    double seconds = 0.0;
    ADCGS_TRY(adcgs_get_info(from->decoder, &info, sizeof info, error));
    ADCGS_TRY(make_frames(s, from, &frames, error));
    const int size[2] = {frames.frame[0].camera.width, frames.frame[0].camera.height};
    adcgs_md5_init(&all);
    adcgs_status status = adcgs_canvas_init(&canvas, size, &info, s->alpha, s->depth, from->beside != NULL, error);
    if (status == ADCGS_OK)
        status = open_sink(&sink, s, &frames, &canvas, error);
    if (sink)
        note_size(cli, s, sink, &canvas.shown);
    if (status == ADCGS_OK)
        status = render(s, from, &frames, sink, &canvas, &all, &seconds, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = adcgs_sink_close(&sink, error);
    if (status == ADCGS_OK)
        status = adcgs_cli_flush(error);
    adcgs_sink_abort(&sink);
    adcgs_canvas_clear(&canvas);
    if (status == ADCGS_OK && !adcgs_interrupted()) {
        uint8_t digest[16];
        char hex[33];
        adcgs_md5_final(&all, digest);
        adcgs_md5_hex(digest, hex);
        *mismatch = s->verify && strcasecmp(s->verify, hex);
        if (*mismatch)
            adcgs_cli_error(cli, ADCGS_OK, "%s: the frames' MD5 is %s, expected %s", s->input, hex, s->verify);
        else
            adcgs_cli_note(cli, "%s: %d frame%s of %dx%d, %.2f ms each", s->input, frames.n, frames.n == 1 ? "" : "s", size[0],
                           size[1], 1e3 * seconds / frames.n);
    }
    adcgs_camera_path_free(&frames);
    return status;
}

/** Answers requests instead of rendering a clip. */
static adcgs_status answer(const adcgs_cli *cli, settings *s, adcgs_decoder **decoder, adcgs_error *error)
{
    adcgs_requests requests;
    ADCGS_TRY(adcgs_requests_read(&requests, s->answer, error));
    s->config.strict_end |= requests.complete;
    s->config.layers = requests.layers ? requests.layers : s->config.layers;
    adcgs_status status = open_input(decoder, &s->source, s->input, s, error);
    const char *const fault = adcgs_fault_class(status);
    if (status == ADCGS_OK)
        status = adcgs_requests_answer(&requests, s->input, *decoder, error);
    else if (fault) {
        printf("fault %s\n", fault);
        adcgs_cli_error(cli, ADCGS_OK, "%s", error->text);
        adcgs_fail(error, status, "%.160s: a fault of class %s", s->input, fault);
    }
    adcgs_requests_clear(&requests);
    return status;
}

/** Plays instead of rendering a clip. */
static adcgs_status play(const adcgs_cli *cli, const settings *s, int *mismatch, adcgs_error *error)
{
    const adcgs_dec_play how = {.cli = cli, .input = s->input, .script = s->script, .request = s->request, .config = s->config};
    const adcgs_status status = adcgs_dec_play_run(&how, mismatch, error);
    if (*mismatch)
        adcgs_cli_error(cli, ADCGS_OK, "%s", error->text);
    return status;
}

/** Shows frames of a stream while it arrives, where possible. The beginning of a pipe's stream may be missing (tune-in). */
static adcgs_status show_live(const adcgs_cli *cli, const settings *s, adcgs_decoder **decoder, int *mismatch, adcgs_error *error)
{
    adcgs_live live;
    adcgs_config config = s->config;
    config.tune_in = !adcgs_is_url(s->input);
    adcgs_status status = adcgs_live_open(&live, decoder, s->input, &config, &s->request, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = adcgs_dec_report_tune_in(cli, *decoder, live.in.name, error);
    if (status == ADCGS_OK)
        status = adcgs_set_tiers(*decoder, s->tiers, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = decode(cli, s, &(streams){*decoder, NULL, &live}, mismatch, error);
    adcgs_live_close(&live);
    return status;
}

/** Resolves --time N% to one of the stream's frames. */
static adcgs_status place_times(settings *s, const adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_info info;
    if (s->part < 0.0)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    const double last = floor((info.time_end - info.time_start) * info.frame_rate + 1e-6);
    s->request.begin = s->request.end = info.time_start + floor(s->part * last + 0.5) / info.frame_rate;
    return ADCGS_OK;
}

/** Writes the stored cameras as a path, or a path as another file. */
static adcgs_status write_cameras(const settings *s, adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_camera_path frames;
    if (!s->request.camera)
        return adcgs_camera_path_write(decoder, NULL, s->request.order, s->cameras, error);
    ADCGS_TRY(adcgs_camera_path_make(&frames, decoder, &s->request, error));
    const adcgs_status status = adcgs_camera_path_write(decoder, &frames, s->request.order, s->cameras, error);
    adcgs_camera_path_free(&frames);
    return status;
}

/** Opens the input and renders, plays or writes it. */
static adcgs_status show(const adcgs_cli *cli, settings *s, adcgs_decoder **decoder, int *mismatch, adcgs_error *error)
{
    streams from = {0};
    const int as_clip = !s->cameras && !s->splats.target && !s->beside && s->budget.of == ADCGS_BUDGET_NONE && s->part < 0.0;
    if (as_clip && (adcgs_pipe_is(s->input) || (adcgs_is_url(s->input) && !s->config.on_demand && !s->config.conceal)))
        return show_live(cli, s, decoder, mismatch, error);
    ADCGS_TRY(open_input(decoder, &s->source, s->input, s, error));
    from.decoder = *decoder;
    ADCGS_TRY(place_times(s, from.decoder, error));
    if (s->cameras)
        return write_cameras(s, from.decoder, error);
    if (s->splats.target)
        return adcgs_dec_splats(cli, from.decoder, s->input, &s->splats, &s->request, error);
    adcgs_status status = s->beside ? open_input(&from.beside, &s->beside_source, s->beside, s, error) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = decode(cli, s, &from, mismatch, error);
    adcgs_close(&from.beside);
    return status;
}

int main(int argc, char **argv)
{
    settings s = {0};
    adcgs_option_table options = {.n = 0};
    adcgs_config_init(&s.config, sizeof s.config);
    adcgs_dec_options(&s, &options);
    const adcgs_cli cli = {.program = "adcgs-dec",
                           .operands = "FILE|URL|-",
                           .summary = "Decode a stream and render frames from it.",
                           .details = "Exit status: 0 done, 1 MD5 or an expectation differs, 2 usage, 3 input or output,\n"
                                      "4 invalid stream, 5 unsupported.",
                           .options = options.rows,
                           .n_options = options.n,
                           .rules = adcgs_dec_rules,
                           .n_rules = ADCGS_DEC_RULES,
                           .min_operands = 1,
                           .max_operands = 1,
                           .quiet = &s.quiet};
    int first, mismatch = 0;
    s.cli = &cli;
    const int done = adcgs_cli_parse(&cli, argc, argv, &first);
    if (done >= 0)
        return done;
    s.input = argv[first];
    adcgs_error error = {0};
    adcgs_decoder *decoder = NULL;
    adcgs_status status = adcgs_dec_check(&s, &error);
    if (status == ADCGS_OK)
        status = adcgs_dec_find_sound(&s, &error);
    if (status == ADCGS_OK)
        status = adcgs_cli_pool(&cli, &s.config.pool, s.config.threads, &error);
    adcgs_interrupt_catch(1);
    s.opened = adcgs_seconds();
    if (status == ADCGS_OK && s.answer)
        status = answer(&cli, &s, &decoder, &error);
    else if (status == ADCGS_OK && s.play)
        status = play(&cli, &s, &mismatch, &error);
    else if (status == ADCGS_OK)
        status = show(&cli, &s, &decoder, &mismatch, &error);
    status = adcgs_operand_explain(&s.source, status, &error);
    status = adcgs_operand_explain(&s.beside_source, status, &error);
    adcgs_close(&decoder);
    adcgs_operand_close(&s.source);
    adcgs_operand_close(&s.beside_source);
    adcgs_pool_free(&s.config.pool);
    free(s.sound);
    if (adcgs_interrupted())
        raise(adcgs_interrupted()); /* ends with the signal, so that the shell sees the reason; the handler is removed by now */
    if (status == ADCGS_OK)
        status = adcgs_cli_flush(&error);
    error.status = status;
    return status != ADCGS_OK ? adcgs_cli_fail(&cli, &error) : mismatch;
}
