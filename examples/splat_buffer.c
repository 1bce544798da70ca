/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The splats at one time as a buffer for a GPU: splat_buffer FILE OUT.bin [SECONDS]. Each splat has 64 bytes, in the std430
 * layout of the struct below (three numbers and a fourth share 16 bytes). This example writes the buffer to a file. Other
 * programs pass it to glBufferData(), vkMapMemory() or writeBuffer(), and upload moving splats again for each time.
 *
 * cc splat_buffer.c $(pkg-config --cflags --libs adcgs)
 */
#include <adcgs/adcgs.h>

#include <stdio.h>
#include <stdlib.h>

/* struct Splat { vec3 mean; float opacity; vec3 scale; float pad0; vec4 rotation; vec3 colour; float pad1; }; */
typedef struct gpu_splat {
    float mean[3];  /* world units */
    float opacity;  /* 0..0.99 */
    float scale[3]; /* world units */
    float pad0;
    float rotation[4]; /* unit quaternion x, y, z, w, the usual order in shaders */
    float colour[3];   /* RGB */
    float pad1;
} gpu_splat;

static gpu_splat pack(const adcgs_primitives *p, uint32_t i, const adcgs_info *info)
{
    gpu_splat s = {.opacity = p->opacity[i]};
    for (int c = 0; c < 3; c++) {
        s.mean[c] = (float)(info->scene_origin[c] + info->scene_scale * (double)p->mean[c][i]);
        s.scale[c] = (float)(info->scene_scale * (double)p->scale[c][i]);
        s.colour[c] = p->colour[c][i];
    }
    for (int c = 0; c < 4; c++)
        s.rotation[c] = p->rotation[(c + 1) % 4][i]; /* the library's order is w, x, y, z */
    return s;
}

/* Slots with opacity 0 are invisible and left out of the buffer. Returns the number of splats in it. */
static size_t fill(gpu_splat *buffer, const adcgs_primitives *primitives, const adcgs_info *info)
{
    size_t n = 0;
    for (uint32_t i = 0; i < primitives->n; i++)
        if (primitives->opacity[i] > 0)
            buffer[n++] = pack(primitives, i, info);
    return n;
}

static adcgs_status write_buffer(const char *path, const gpu_splat *buffer, size_t n)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return ADCGS_ERR_IO;
    const size_t written = fwrite(buffer, sizeof *buffer, n, file);
    return fclose(file) || written < n ? ADCGS_ERR_IO : ADCGS_OK;
}

static adcgs_status convert(const char *input, const char *output, double seconds, adcgs_error *error)
{
    adcgs_decoder *decoder;
    adcgs_info info;
    adcgs_primitives primitives;
    adcgs_status status = adcgs_open_file(&decoder, input, NULL, error);
    if (status != ADCGS_OK)
        return status;
    status = adcgs_get_info(decoder, &info, sizeof info, error);
    if (status == ADCGS_OK)
        status = adcgs_get_primitives(decoder, seconds, &primitives, error);
    if (status == ADCGS_OK) {
        gpu_splat *buffer = malloc(primitives.n * sizeof *buffer);
        const size_t n = buffer ? fill(buffer, &primitives, &info) : 0;
        status = buffer ? write_buffer(output, buffer, n) : ADCGS_ERR_MEMORY;
        free(buffer);
        printf("%zu splats, %zu bytes each\n", n, sizeof *buffer);
    }
    adcgs_close(&decoder);
    return status;
}

int main(int argc, char **argv)
{
    adcgs_error error = {ADCGS_OK, ""};
    if (argc < 3 || argc > 4) {
        fprintf(stderr, "usage: %s FILE OUT.bin [SECONDS]\n", argv[0]);
        return 2;
    }
    const adcgs_status status = convert(argv[1], argv[2], argc > 3 ? atof(argv[3]) : 0, &error);
    if (status != ADCGS_OK)
        fprintf(stderr, "%s: %s\n", argv[0], error.status == status ? error.text : adcgs_status_name(status));
    return status == ADCGS_OK ? 0 : 1;
}
