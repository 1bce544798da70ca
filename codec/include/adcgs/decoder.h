/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoding: open a stream, query its contents, derive primitives, render frames.
 *
 * Only one thread at a time may use a decoder. Different decoders are independent, even when they share a pool. All results are
 * bit-identical on every CPU, CPU level and number of threads.
 *
 * Streams may be hostile. The level of a stream bounds the memory and time of opening it, independent of the stream's size: at
 * most 64 MiB at level 1, half a GiB at level 2, and one or two seconds of one core. The decoder checks these bounds before it
 * spends the memory or time. With segments read on demand, a call that takes a time or a segment number may need as long. In a
 * faulty stream such a call may need up to twice as long. Once per decoder, if the index is wrong, a call may need four times as
 * long. The time for reading the bytes is extra. The caller chooses the size of a frame. Its time and memory grow with pixels
 * times splats, and memory_limit bounds both (annex "Security and resources").
 *
 * Unless a function says otherwise, error is the only pointer that may be NULL. In addition to the failures that a function
 * lists, it can fail with ADCGS_ERR_USAGE, ADCGS_ERR_MEMORY and, if it allocates, ADCGS_ERR_LIMIT (memory_limit).
 */
#ifndef ADCGS_DECODER_H
#define ADCGS_DECODER_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Set all members to their defaults. Writes exactly size bytes, the size that the caller's headers know.
 * \param config the caller's struct
 * \param size sizeof(adcgs_config)
 */
ADCGS_API void adcgs_config_init(adcgs_config *config, size_t size);

/**
 * Open a file and decode it completely: all segments and all requested layers (clause "Stream"). With config.on_demand, a file of
 * several segments is read as by adcgs_open_at() and stays open.
 * \param out receives the decoder, to be closed with adcgs_close(); NULL on failure
 * \param path name of the file
 * \param config how to decode; NULL: all defaults. Not needed after the call, except for the objects that its members point to
 * \param error says why it failed
 * \return ADCGS_OK; ADCGS_ERR_IO if reading failed; ADCGS_ERR_DATA, ADCGS_ERR_TRUNCATED, ADCGS_ERR_UNSUPPORTED or ADCGS_ERR_LIMIT
 *         (clause "Faults") if the stream cannot be decoded; ADCGS_ERR_UNSUPPORTED if config asks for a feature that this
 *         library, build or machine lacks; ADCGS_ERR_FPENV if floating-point arithmetic does not follow the specification
 */
ADCGS_API adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error);

/**
 * Open a stream in memory, as adcgs_open_file() opens a file.
 * \param out receives the decoder; NULL on failure
 * \param data the stream; not needed after the call. May be NULL if there are no bytes
 * \param bytes its size
 * \param config how to decode; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_file()
 */
ADCGS_API adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                                         adcgs_error *error);

/**
 * Open a stream from a pipe or any other sequential source, as adcgs_open_file() opens a file. The stream is read once, in order,
 * up to its end and not beyond. With config.tune_in, the beginning of the stream may be missing (tune-in). The decoder then skips
 * bytes up to the next HEAD and segments up to the next key; info.first_segment is the number of segments missed. The same holds
 * for adcgs_push().
 * \param out receives the decoder; NULL on failure
 * \param read delivers the bytes; not called after this function has returned
 * \param user passed to read
 * \param config how to decode; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_file()
 */
ADCGS_API adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                                         adcgs_error *error);

/**
 * Open a stream with random access, for example over a network by byte ranges. The function reads only the header and the index,
 * or the headers of all chunks if there is no index (clause "Seeking"). A segment is read and decoded when the caller requests it
 * or a time in it, together with the segments that it is predicted from, back to the last key before it. It replaces the previous
 * segment in memory; during a crossfade both stay. So a stream of any length needs at most the memory of two of its segments.
 * Parts that were not read were not checked. A stream of one segment, and one that ends early, is read as by adcgs_open_stream().
 *
 * Functions that take a time or a segment number can then fail as adcgs_open_stream() can. The decoder remains usable, and
 * adcgs_info.segments does not change. If a segment shows that the index is wrong, the decoder takes times and positions from the
 * segments themselves, provided that their number is that of the index. Otherwise these segments fail (ADCGS_ERR_DATA). The
 * bounds of the level apply to all segments decoded so far: a stream that adcgs_open_stream() refuses as a whole fails here at
 * the segment that exceeds a bound (ADCGS_ERR_LIMIT).
 * \param out receives the decoder; NULL on failure
 * \param read delivers bytes from any position; called as long as the decoder is open
 * \param user passed to read
 * \param bytes size of the stream
 * \param config how to decode; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_stream()
 */
ADCGS_API adcgs_status adcgs_open_at(adcgs_decoder **out, adcgs_read_at_fn read, void *user, uint64_t bytes,
                                     const adcgs_config *config, adcgs_error *error);

/**
 * Open a decoder for bytes that arrive over time, given to it with adcgs_push(). Before the first ADCGS_ARRIVED_HEADER queries
 * fail, before the first ADCGS_ARRIVED_SEGMENT rendering fails (ADCGS_ERR_USAGE). From then on, the segments received so far
 * serve all times. The last one serves with the parts received so far: its missing layers are concealed.
 * \param out receives the decoder; NULL on failure
 * \param config how to decode; may be NULL. on_demand and conceal have no effect
 * \param error says why it failed
 * \return as adcgs_open_stream(), without the failures that a stream can cause
 */
ADCGS_API adcgs_status adcgs_open_push(adcgs_decoder **out, const adcgs_config *config, adcgs_error *error);

/**
 * Give the next bytes of the stream, any number of them, to a decoder that adcgs_open_push() opened. The function takes bytes at
 * most up to the end of the current chunk, so that a call never takes longer than decoding one chunk. It reports the result in
 * arrived. The caller passes the remaining bytes in further calls.
 * \param decoder an open decoder
 * \param data bytes; not needed after the call. May be NULL if there are none
 * \param bytes their number
 * \param used receives the number of bytes taken: all of them, unless something has arrived or a chunk ends
 * \param arrived receives the part of the stream that these bytes completed
 * \param error says why it failed
 * \return as adcgs_open_stream(). A failure is final, but the parts that arrived before it can still be rendered
 */
ADCGS_API adcgs_status adcgs_push(adcgs_decoder *decoder, const void *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                                  adcgs_error *error);

/**
 * Declare that no time before this one will be requested again. The decoder frees past segments whose crossfade into the next one
 * has ended, except the last complete segment, from which the next may be predicted. So a stream of any length needs at most the
 * memory of a few segments, in addition to its networks, which its level bounds. The first remaining segment then serves earlier
 * times. Segment numbers do not change. The models of freed segments are no longer available (ADCGS_ERR_USAGE).
 * \param decoder an open decoder
 * \param time seconds
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if adcgs_open_push() did not open the decoder
 */
ADCGS_API adcgs_status adcgs_push_discard_before(adcgs_decoder *decoder, double time, adcgs_error *error);

/**
 * Declare that no more bytes will come. If the stream has not ended, its complete part remains, as with adcgs_open_stream().
 * \param decoder an open decoder
 * \param error says why it failed
 * \return as adcgs_push()
 */
ADCGS_API adcgs_status adcgs_push_end(adcgs_decoder *decoder, adcgs_error *error);

/**
 * Close a decoder and free everything that it owns.
 * \param decoder is set to NULL; may point to NULL
 */
ADCGS_API void adcgs_close(adcgs_decoder **decoder);

/**
 * Get a summary of the stream. Writes exactly size bytes, the size that the caller's headers know.
 * \param decoder an open decoder
 * \param info the caller's struct
 * \param size sizeof(adcgs_info)
 * \param error says why it failed
 * \return ADCGS_OK or ADCGS_ERR_USAGE
 */
ADCGS_API adcgs_status adcgs_get_info(const adcgs_decoder *decoder, adcgs_info *info, size_t size, adcgs_error *error);

/**
 * Get a camera that the stream stores (clause "cams").
 * \param decoder an open decoder
 * \param index 0 .. adcgs_info.cameras - 1
 * \param camera receives it
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if there is no such camera
 */
ADCGS_API adcgs_status adcgs_get_camera(const adcgs_decoder *decoder, int index, adcgs_camera *camera, adcgs_error *error);

/**
 * Get the time at which a stored camera filmed (clause "cams"). The keys of a filmed path have successive indices and ascending
 * times; between them an application interpolates.
 * \param decoder an open decoder
 * \param index 0 .. adcgs_info.cameras - 1
 * \param time receives seconds; NaN if the camera has no time
 * \param path receives the number of the path that the camera is a key of, 0 for the first path; -1 if it is none
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if there is no such camera
 */
ADCGS_API adcgs_status adcgs_get_camera_time(const adcgs_decoder *decoder, int index, double *time, int *path,
                                             adcgs_error *error);

/**
 * Get a text that the stream stores (clause "meta"). Its contents are untrusted: UTF-8 is promised, not checked.
 * \param decoder an open decoder
 * \param key of the text
 * \return the first text of that key; NULL if there is none. Owned by the decoder
 */
ADCGS_API const char *adcgs_get_metadata(const adcgs_decoder *decoder, const char *key);

/**
 * Get the key of a stored text. The texts are in the stream's order.
 * \param decoder an open decoder
 * \param index 0 .. adcgs_info.metadata - 1
 * \return the key; NULL if there is none. Owned by the decoder
 */
ADCGS_API const char *adcgs_get_metadata_key(const adcgs_decoder *decoder, int index);

/**
 * Get the splats at a time (clause "Primitives"). During a crossfade they are those of the new segment alone; frames also show
 * the previous segment.
 * \param decoder an open decoder
 * \param time seconds; a time outside the stream's range becomes its start or end
 * \param out receives arrays that the decoder owns, valid until the next call on it that takes a time, a segment or tiers
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_FPENV if the calling thread's floating-point modes were changed
 */
ADCGS_API adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out, adcgs_error *error);

/**
 * From now on, render only the first tiers: fewer splats and a coarser image in less time (clause "Tiers"). A segment that has
 * fewer tiers, or has received fewer so far, is rendered with all available ones.
 * \param decoder an open decoder
 * \param tiers their number, at least 1; 0: all, the state after opening
 * \param error says why it failed
 * \return ADCGS_OK or ADCGS_ERR_USAGE
 */
ADCGS_API adcgs_status adcgs_set_tiers(adcgs_decoder *decoder, int tiers, adcgs_error *error);

/**
 * Render a frame (clause "Rendering"). All conforming decoders give the same bits. During a crossfade a frame takes twice as
 * long.
 * \param decoder an open decoder
 * \param camera any camera, not only the stream's
 * \param time seconds, as adcgs_get_primitives()
 * \param frame width and height equal the camera's; rgb receives [height][width][3]
 * \param error says why it failed
 * \return ADCGS_OK; ADCGS_ERR_USAGE if the camera or the frame is not as described; ADCGS_ERR_LIMIT if the splats cover more
 *         than 2^28 tiles of 16x16 pixels, counted splat by splat; ADCGS_ERR_FPENV as adcgs_get_primitives()
 */
ADCGS_API adcgs_status adcgs_render(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_frame *frame,
                                    adcgs_error *error);

/**
 * Render to 8 bits per sample: R, G, B, A, each converted as by adcgs_frame_to_u8(). Opaque images equal those of adcgs_render();
 * the other kinds take a second pass, for coverage. The result is as deterministic as frames.
 * \param decoder an open decoder
 * \param camera as adcgs_render()
 * \param time as adcgs_render()
 * \param alpha meaning of A, and whether colours are multiplied by it
 * \param pixels the first pixel of the top row; a row has 4 * width bytes
 * \param stride bytes from a row to the one below it, at least 4 * width; at most -4 * width if rows are stored bottom up
 * \param error says why it failed
 * \return as adcgs_render()
 */
ADCGS_API adcgs_status adcgs_render_rgba8(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_alpha alpha,
                                          uint8_t *pixels, ptrdiff_t stride, adcgs_error *error);

/**
 * Render depth and coverage, of the same splats and with the same weights as adcgs_render(). This separate pass takes as long as
 * a frame. A frame less (1 - alpha) times the background gives its colours premultiplied by alpha. The result is as deterministic
 * as frames, but no point of conformance.
 * \param decoder an open decoder
 * \param camera as adcgs_render()
 * \param time as adcgs_render()
 * \param depth receives [height][width], world units along the camera's axis: the weighted mean of the splats' depths;
 *        ADCGS_DEPTH_FAR where alpha is 0. May be NULL
 * \param alpha receives [height][width], 0..1: the sum of the splats' weights, equal to 1 less the weight of the background in
 *        the frame. May be NULL
 * \param error says why it failed
 * \return as adcgs_render()
 */
ADCGS_API adcgs_status adcgs_render_depth(adcgs_decoder *decoder, const adcgs_camera *camera, double time, float *depth,
                                          float *alpha, adcgs_error *error);

/**
 * Conformance point M: MD5 of the decoded model of a segment (clause "Model digest").
 * \param decoder an open decoder
 * \param segment adcgs_info.first_segment .. adcgs_info.segments - 1
 * \param digest receives 16 bytes
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if there is no such segment
 */
ADCGS_API adcgs_status adcgs_get_model_digest(adcgs_decoder *decoder, int segment, uint8_t digest[16], adcgs_error *error);

/**
 * Conformance point S: MD5 of the splats at a time, as adcgs_get_primitives() gives them (clause "Splats").
 * \param decoder an open decoder
 * \param time as adcgs_get_primitives()
 * \param digest receives 16 bytes
 * \param error says why it failed
 * \return as adcgs_get_primitives()
 */
ADCGS_API adcgs_status adcgs_get_splat_digest(adcgs_decoder *decoder, double time, uint8_t digest[16], adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
