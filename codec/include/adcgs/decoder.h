/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoding: open a stream, ask what it holds, derive primitives, render frames.
 *
 * One thread at a time may use a decoder; different decoders are independent, also when they share a pool. All results are
 * bit-identical on every CPU, CPU level and number of threads.
 *
 * Streams may come from strangers. Opening one takes memory and time that its level bounds before they are spent, whatever its
 * size: with level 1 at most 64 MiB, with level 2 half a GiB, and one or two seconds of one core. Where segments are read on
 * demand, a call that asks for a time or a segment may take as long; where the stream has a fault, up to twice that, and once in
 * the life of a decoder, where its index is wrong, four times. Reading itself comes on top. A frame is as large as the
 * caller wants it, and its time and memory grow with pixels times splats; memory_limit bounds both (annex "Security and
 * resources").
 *
 * Unless a function says otherwise, its error may be NULL, no other pointer may be, and besides the failures that it names it
 * can fail with ADCGS_ERR_USAGE, ADCGS_ERR_MEMORY and, where it allocates, ADCGS_ERR_LIMIT by memory_limit.
 */
#ifndef ADCGS_DECODER_H
#define ADCGS_DECODER_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Set all members to their defaults. Writes size bytes, those that the caller's headers know: never more.
 * \param config the caller's struct
 * \param size sizeof(adcgs_config)
 */
ADCGS_API void adcgs_config_init(adcgs_config *config, size_t size);

/**
 * Open a file and decode it completely: all segments, all layers asked for (clause "Stream"). With config.on_demand a file of
 * several segments is read as adcgs_open_at() does, and stays open.
 * \param out receives the decoder, to be closed with adcgs_close(); NULL on failure
 * \param path name of the file
 * \param config how; NULL: all defaults. Not needed after the call, but for what it points to
 * \param error says why it failed
 * \return ADCGS_OK; ADCGS_ERR_IO if reading failed; ADCGS_ERR_DATA, ADCGS_ERR_TRUNCATED, ADCGS_ERR_UNSUPPORTED or ADCGS_ERR_LIMIT
 *         (clause "Faults") if the stream is not one that can be decoded; ADCGS_ERR_UNSUPPORTED if config asks for what this
 *         library, build or machine has not; ADCGS_ERR_FPENV if arithmetic is not what the specification demands
 */
ADCGS_API adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error);

/**
 * Open a stream in memory, as adcgs_open_file() does a file.
 * \param out receives the decoder; NULL on failure
 * \param data the stream; not needed after the call. May be NULL if there are no bytes
 * \param bytes its size
 * \param config how; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_file()
 */
ADCGS_API adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                                         adcgs_error *error);

/**
 * Open a stream from a pipe or any other sequential source, as adcgs_open_file() does a file. It is read in order, once, to the
 * end of the stream and not beyond. With config.join its beginning may be missing: bytes up to the next HEAD are passed over, and
 * segments up to the next key; info.first_segment says how many were missed. So may it with adcgs_push().
 * \param out receives the decoder; NULL on failure
 * \param read gives the bytes; not called after this call
 * \param user for read
 * \param config how; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_file()
 */
ADCGS_API adcgs_status adcgs_open_stream(adcgs_decoder **out, adcgs_read_fn read, void *user, const adcgs_config *config,
                                         adcgs_error *error);

/**
 * Open a stream of which any part can be read, as over a network by ranges. Only the header and the index are read, or where
 * there is none the headers of chunks (clause "Seeking"); a segment is read and decoded when a time or number in it is asked for,
 * with those that it is predicted from, back to the last key before it, and takes the place of the one before; where it is faded
 * in, both are there. So a stream of any length takes no more memory than two of its segments. What was not read was not checked.
 * A stream of one segment, and one that ends early, is read as adcgs_open_stream() does.
 *
 * Functions that take a time or the number of a segment can then fail as adcgs_open_stream() does; the decoder remains usable,
 * and adcgs_info.segments stays. If a segment shows that the index is wrong, times and places are taken from the segments
 * themselves, as long as their number is that of the index; otherwise these segments fail (ADCGS_ERR_DATA). The bounds of the
 * level hold for all segments that were decoded so far: a stream that is refused as a whole fails here at the segment that
 * exceeds a bound (ADCGS_ERR_LIMIT).
 * \param out receives the decoder; NULL on failure
 * \param read gives bytes at a position, as long as the decoder is open
 * \param user for read
 * \param bytes size of the stream
 * \param config how; may be NULL
 * \param error says why it failed
 * \return as adcgs_open_stream()
 */
ADCGS_API adcgs_status adcgs_open_at(adcgs_decoder **out, adcgs_read_at_fn read, void *user, uint64_t bytes,
                                     const adcgs_config *config, adcgs_error *error);

/**
 * Open a decoder that is given bytes as they come, with adcgs_push(). Until the first ADCGS_ARRIVED_HEADER nothing can be asked
 * of it, until the first ADCGS_ARRIVED_SEGMENT nothing drawn (ADCGS_ERR_USAGE). Then times are served by the segments that came
 * so far, the last as far as it came: layers that did not are concealed.
 * \param out receives the decoder; NULL on failure
 * \param config how; may be NULL. on_demand and conceal are of no influence
 * \param error says why it failed
 * \return as adcgs_open_stream(), less what the stream may cause
 */
ADCGS_API adcgs_status adcgs_open_push(adcgs_decoder **out, const adcgs_config *config, adcgs_error *error);

/**
 * Give bytes of the stream to a decoder that adcgs_open_push() opened, any number, in order. It takes those to the end of the
 * part at hand at most, so that a call takes no longer than one part does, and tells what they have brought; call again with
 * those that are left.
 * \param decoder an open decoder
 * \param data bytes; not needed after the call. May be NULL if there are none
 * \param bytes how many
 * \param used receives how many were taken; all of them, unless something has arrived or a part ends
 * \param arrived receives what they have brought
 * \param error says why it failed
 * \return as adcgs_open_stream(); a failure is final, but what was there before can be drawn
 */
ADCGS_API adcgs_status adcgs_push(adcgs_decoder *decoder, const void *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                                  adcgs_error *error);

/**
 * Say that no moment before this one will be asked for again: segments that are past, and into which nothing fades any more, are
 * freed, all but the last complete one, from which the next may be predicted. So a stream of any length takes no more memory than
 * a few of its segments, besides its networks, which its level bounds. Times before are served by the first segment that is left.
 * Numbers of segments stay, and the models of those that are freed cannot be asked for (ADCGS_ERR_USAGE).
 * \param decoder an open decoder
 * \param time seconds
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if bytes are not pushed to the decoder
 */
ADCGS_API adcgs_status adcgs_push_forget(adcgs_decoder *decoder, double time, adcgs_error *error);

/**
 * Say that no more bytes will come. Of a stream that has not ended what is complete remains, as adcgs_open_stream() has it.
 * \param decoder an open decoder
 * \param error says why it failed
 * \return as adcgs_push()
 */
ADCGS_API adcgs_status adcgs_push_end(adcgs_decoder *decoder, adcgs_error *error);

/**
 * Close a decoder and free all it owns.
 * \param decoder is set to NULL; may point to NULL
 */
ADCGS_API void adcgs_close(adcgs_decoder **decoder);

/**
 * What the stream holds. Writes size bytes, those that the caller's headers know: never more.
 * \param decoder an open decoder
 * \param info the caller's struct
 * \param size sizeof(adcgs_info)
 * \param error says why it failed
 * \return ADCGS_OK or ADCGS_ERR_USAGE
 */
ADCGS_API adcgs_status adcgs_get_info(const adcgs_decoder *decoder, adcgs_info *info, size_t size, adcgs_error *error);

/**
 * A camera that the stream stores (clause "cams").
 * \param decoder an open decoder
 * \param index 0 .. adcgs_info.cameras - 1
 * \param camera receives it
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_USAGE if there is no such camera
 */
ADCGS_API adcgs_status adcgs_get_camera(const adcgs_decoder *decoder, int index, adcgs_camera *camera, adcgs_error *error);

/**
 * Text that the stream stores (clause "meta"). It comes from whoever wrote the stream: UTF-8 is promised, not checked.
 * \param decoder an open decoder
 * \param key of the text
 * \return the first text of that key; NULL if there is none. Owned by the decoder
 */
ADCGS_API const char *adcgs_get_metadata(const adcgs_decoder *decoder, const char *key);

/**
 * The keys of those texts, in the stream's order.
 * \param decoder an open decoder
 * \param index 0 .. adcgs_info.metadata - 1
 * \return the key; NULL if there is none. Owned by the decoder
 */
ADCGS_API const char *adcgs_get_metadata_key(const adcgs_decoder *decoder, int index);

/**
 * Splats at a time (clause "Primitives"). While a segment is faded in they are its own; frames show the one before, too.
 * \param decoder an open decoder
 * \param time seconds; times outside the stream's span become its start or end
 * \param out receives arrays that the decoder owns; valid until the next call on it that takes a time
 * \param error says why it failed
 * \return ADCGS_OK, or ADCGS_ERR_FPENV if the calling thread's modes of arithmetic were changed
 */
ADCGS_API adcgs_status adcgs_get_primitives(adcgs_decoder *decoder, double time, adcgs_primitives *out, adcgs_error *error);

/**
 * Draw the first tiers alone from now on: fewer splats, and a coarser picture, in less time (clause "Tiers"). What there is to be
 * drawn decides which tiers there are: of a stream that has come in part, of segments that have fewer.
 * \param decoder an open decoder
 * \param tiers how many, at least 1; 0: all, as it was opened
 * \param error says why it failed
 * \return ADCGS_OK or ADCGS_ERR_USAGE
 */
ADCGS_API adcgs_status adcgs_set_tiers(adcgs_decoder *decoder, int tiers, adcgs_error *error);

/**
 * Render a frame (clause "Rendering"): what conforming decoders agree on to the bit. It takes twice as long where a segment is
 * faded in.
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
 * Render to 8 bits a sample: R, G, B, A, each as adcgs_frame_to_u8() would convert it. Opaque pictures are those of
 * adcgs_render(); the others take a second pass, for coverage. As deterministic as frames.
 * \param decoder an open decoder
 * \param camera as adcgs_render()
 * \param time as adcgs_render()
 * \param alpha what A is, and whether colours are multiplied by it
 * \param pixels the first pixel of the top row; a row has 4 * width bytes
 * \param stride bytes from a row to the one below it, at least 4 * width; negative, as large, if rows lie bottom up
 * \param error says why it failed
 * \return as adcgs_render()
 */
ADCGS_API adcgs_status adcgs_render_rgba8(adcgs_decoder *decoder, const adcgs_camera *camera, double time, adcgs_alpha alpha,
                                          uint8_t *pixels, ptrdiff_t stride, adcgs_error *error);

/**
 * Depth and coverage, of the splats and with the weights of adcgs_render(), in a pass of its own that takes as long as a frame.
 * A frame less (1 - alpha) times the background is its colours premultiplied by alpha. As deterministic as frames, but not a
 * point of conformance.
 * \param decoder an open decoder
 * \param camera as adcgs_render()
 * \param time as adcgs_render()
 * \param depth receives [height][width], world units along the camera's axis: the mean of the splats' depths by their weights;
 *        ADCGS_DEPTH_FAR where alpha is 0. May be NULL
 * \param alpha receives [height][width], 0..1: the sum of the splats' weights, which is 1 less the part of the background that
 *        the frame shows. May be NULL
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
