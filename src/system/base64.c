/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bytes in the letters of base 64 (RFC 4648). */
#include "config.h"

#include "system/base64.h"

void adcgs_base64_write(FILE *file, const uint8_t *data, size_t bytes, int lines)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes; i += 3) {
        const size_t n = ADCGS_MIN(bytes - i, 3);
        const uint32_t three = (uint32_t)data[i] << 16 | (uint32_t)(n > 1 ? data[i + 1] : 0) << 8 | (n > 2 ? data[i + 2] : 0);
        const char four[4] = {letters[three >> 18], letters[three >> 12 & 63], n > 1 ? letters[three >> 6 & 63] : '=',
                              n > 2 ? letters[three & 63] : '='};
        fwrite(four, 1, sizeof four, file);
        if (lines && (i % 57 == 54 || i + 3 >= bytes))
            fputc('\n', file);
    }
}

int adcgs_base64_value(int c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}
