/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers of a GLB file. */
#include "config.h"

#include "media/splats/glb_numbers.h"

#include "media/splats/glb.h"

#include <math.h>

#define INT_MAX_IN_JSON ((json_int_t)1 << 53) /* whole numbers up to here are exact in a double; arithmetic */
#define STRIDE_MAX 252                        /* bytes; definition (glTF 2.0, bufferView.byteStride) */

/* Component types; definition (glTF 2.0, accessor.componentType). */
enum { INT8 = 5120, UINT8, INT16, UINT16 };

/** The attribute that is searched, for messages. */
typedef struct finder {
    const adcgs_glb *glb;
    const char *name;
} finder;

static adcgs_status bad(const finder *f, adcgs_status status, const char *what)
{
    return adcgs_fail(f->glb->error, status, "%s: glTF: %s: %s", f->glb->path, f->name, what);
}

/** Size of a component type [bytes]; 0 for an unknown type. */
static uint64_t size_of(json_int_t type)
{
    return type == ADCGS_GLB_FLOAT ? 4 : type == INT8 || type == UINT8 ? 1 : type == INT16 || type == UINT16 ? 2 : 0;
}

/** Read a count, size or index. missing: the value if the key is absent; if negative, an absent key is an error. */
static adcgs_status get_count(const finder *f, json_t *object, const char *key, json_int_t missing, uint64_t *out)
{
    const json_t *const value = json_object_get(object, key);
    const json_int_t number = value ? json_is_integer(value) ? json_integer_value(value) : -1 : missing;
    *out = 0;
    if (number < 0 || number > INT_MAX_IN_JSON)
        return adcgs_fail(f->glb->error, ADCGS_ERR_DATA, "%s: glTF: %s: %s: expected a whole number", f->glb->path, f->name, key);
    *out = (uint64_t)number;
    return ADCGS_OK;
}

/** The element of an array at the root that object[key] refers to. */
static adcgs_status get_element(const finder *f, const char *array, json_t *object, const char *key, json_t **out)
{
    uint64_t index;
    ADCGS_TRY(get_count(f, object, key, -1, &index));
    *out = json_array_get(json_object_get(f->glb->root, array), (size_t)index);
    if (!json_is_object(*out))
        return adcgs_fail(f->glb->error, ADCGS_ERR_DATA, "%s: glTF: %s: no %s %llu", f->glb->path, f->name, array,
                          (unsigned long long)index);
    return ADCGS_OK;
}

/** The bytes of a view into the buffer that is the binary chunk. */
static adcgs_status get_bytes(const finder *f, json_t *view, const uint8_t **at, uint64_t *bytes)
{
    json_t *buffer;
    uint64_t offset, length;
    ADCGS_TRY(get_element(f, "buffers", view, "buffer", &buffer));
    ADCGS_TRY(get_count(f, view, "byteOffset", 0, &offset));
    ADCGS_TRY(get_count(f, view, "byteLength", -1, bytes));
    ADCGS_TRY(get_count(f, buffer, "byteLength", -1, &length));
    if (json_object_get(view, "extensions"))
        return bad(f, ADCGS_ERR_UNSUPPORTED, "packed by another extension");
    if (json_object_get(buffer, "uri") || json_integer_value(json_object_get(view, "buffer")))
        return bad(f, ADCGS_ERR_UNSUPPORTED, "a buffer outside of the file, expected its binary chunk");
    if (!f->glb->numbers)
        return bad(f, ADCGS_ERR_DATA, "the file has no binary chunk");
    if (length > f->glb->n_bytes)
        return adcgs_fail(f->glb->error, ADCGS_ERR_DATA, "%s: glTF: a buffer of %llu bytes, but the binary chunk has %zu",
                          f->glb->path, (unsigned long long)length, f->glb->n_bytes);
    if (offset > length || *bytes > length - offset)
        return bad(f, ADCGS_ERR_DATA, "a view extends beyond its buffer");
    *at = f->glb->numbers + offset;
    return ADCGS_OK;
}

adcgs_status adcgs_glb_bytes(const uint8_t **at, size_t *bytes, const adcgs_glb *glb, json_t *object, const char *name)
{
    const finder f = {glb, name};
    json_t *view;
    uint64_t length;
    ADCGS_TRY(get_element(&f, "bufferViews", object, "bufferView", &view));
    ADCGS_TRY(get_bytes(&f, view, at, &length));
    *bytes = (size_t)length;
    return ADCGS_OK;
}

static adcgs_status check_type(const finder *f, json_t *accessor, int components)
{
    static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const char *const type = json_string_value(json_object_get(accessor, "type"));
    if (!type || strcmp(type, types[components - 1]))
        return adcgs_fail(f->glb->error, ADCGS_ERR_DATA, "%s: glTF: %s: of type %s, expected %s", f->glb->path, f->name,
                          type ? type : "none", types[components - 1]);
    if (json_object_get(accessor, "sparse"))
        return bad(f, ADCGS_ERR_UNSUPPORTED, "a sparse accessor");
    return ADCGS_OK;
}

adcgs_status adcgs_glb_find(adcgs_glb_view *view, const adcgs_glb *glb, const char *name, int components)
{
    const finder f = {glb, name};
    json_t *accessor, *bytes_view;
    uint64_t count, offset, stride, type, bytes;
    if (!json_object_get(glb->attributes, name))
        return bad(&f, ADCGS_ERR_DATA, "missing, expected for splats");
    ADCGS_TRY(get_element(&f, "accessors", glb->attributes, name, &accessor));
    ADCGS_TRY(check_type(&f, accessor, components));
    ADCGS_TRY(get_count(&f, accessor, "count", -1, &count));
    ADCGS_TRY(get_count(&f, accessor, "byteOffset", 0, &offset));
    ADCGS_TRY(get_count(&f, accessor, "componentType", -1, &type));
    const uint64_t element = (uint64_t)components * size_of((json_int_t)type);
    if (!element)
        return bad(&f, ADCGS_ERR_DATA, "componentType: expected 5120 to 5123 or 5126");
    if (!count || count > ADCGS_SPLATS_MAX)
        return adcgs_fail(glb->error, ADCGS_ERR_DATA, "%s: glTF: %s: %llu elements, expected 1 to %u", glb->path, name,
                          (unsigned long long)count, ADCGS_SPLATS_MAX);
    ADCGS_TRY(get_element(&f, "bufferViews", accessor, "bufferView", &bytes_view));
    ADCGS_TRY(get_bytes(&f, bytes_view, &view->at, &bytes));
    ADCGS_TRY(get_count(&f, bytes_view, "byteStride", (json_int_t)element, &stride));
    if (stride < element || stride > STRIDE_MAX)
        return bad(&f, ADCGS_ERR_DATA, "byteStride: expected at least an element's bytes, and at most 252");
    if (offset > bytes || stride * (count - 1) + element > bytes - offset)
        return bad(&f, ADCGS_ERR_DATA, "an accessor extends beyond its view");
    view->at += offset;
    view->stride = (size_t)stride;
    view->count = (uint32_t)count;
    view->type = (int)type;
    view->is_normal = json_is_true(json_object_get(accessor, "normalized"));
    return ADCGS_OK;
}

double adcgs_glb_number(const adcgs_glb_view *view, uint32_t i, int c)
{
    const uint8_t *const at = view->at + view->stride * i;
    switch (view->type) {
    case INT8: {
        const int value = at[c] < 128 ? at[c] : at[c] - 256;
        return view->is_normal ? fmax(value / 127.0, -1.0) : value;
    }
    case UINT8:
        return view->is_normal ? at[c] / 255.0 : at[c];
    case INT16: {
        const int raw = adcgs_load_le16(at + 2 * c), value = raw < 32768 ? raw : raw - 65536;
        return view->is_normal ? fmax(value / 32767.0, -1.0) : value;
    }
    case UINT16:
        return view->is_normal ? adcgs_load_le16(at + 2 * c) / 65535.0 : adcgs_load_le16(at + 2 * c);
    default:
        return (double)adcgs_bits_float(adcgs_load_le32(at + 4 * c));
    }
}
