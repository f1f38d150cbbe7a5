/* Strict reading of numbers: the whole word, in range, or not at all. */
#ifndef PPM_CLI_VALUES_H
#define PPM_CLI_VALUES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Decimal digits only, no sign. *out_value is written only on success, in all of these. */
bool value_parse_integer(const char *text, uint64_t *out_value);
/* An integer that may end in k, M or G: times 1024, 1024^2, 1024^3. */
bool value_parse_count(const char *text, uint64_t *out_value);
/* A finite number in decimal or exponent notation. */
bool value_parse_real(const char *text, double *out_value);
/* "0.5,-1,2": exactly count such numbers. */
bool value_parse_reals(const char *text, double *out_values, size_t count);
/* "1280x720": two integers that fit 32 bits. */
bool value_parse_size(const char *text, uint32_t *out_width, uint32_t *out_height);

#endif
