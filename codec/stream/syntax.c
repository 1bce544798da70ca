/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The tables for the lists of syntax.h, and for each structure the two functions that use its table. */
#include "stream/syntax.h"

#include "geom/geom.h"

#define FIELD(type, name, min, max) {#name, ADCGS_##type, 1, offsetof(current, name), min, max},
#define FIELDS(type, name, count, min, max) {#name, ADCGS_##type, count, offsetof(current, name), min, max},

#define DEFINE(list, structure)                                                                                  \
    static const adcgs_field *structure##_fields(size_t *n)                                                      \
    {                                                                                                            \
        typedef structure current;                                                                               \
        static const adcgs_field fields[] = {ADCGS_LIST_##list(FIELD, FIELDS)};                                  \
        *n = ADCGS_COUNTOF(fields);                                                                              \
        return fields;                                                                                           \
    }                                                                                                            \
    adcgs_status structure##_parse(adcgs_parse *p, structure *s)                                                 \
    {                                                                                                            \
        size_t n;                                                                                                \
        const adcgs_field *fields = structure##_fields(&n);                                                      \
        return adcgs_parse_fields(p, fields, n, s);                                                              \
    }                                                                                                            \
    adcgs_status structure##_write(adcgs_buffer *out, const char *chunk, const structure *s, adcgs_error *error) \
    {                                                                                                            \
        size_t n;                                                                                                \
        const adcgs_field *fields = structure##_fields(&n);                                                      \
        return adcgs_write_fields(out, chunk, fields, n, s, error);                                              \
    }
ADCGS_STRUCTURES(DEFINE)
