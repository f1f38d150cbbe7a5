/* Parts of JSON that more than one of the program's files has. */
#ifndef PPM_CLI_FEATURES_JSON_H
#define PPM_CLI_FEATURES_JSON_H

#include <jansson.h>

#include "ppm/asset.h"

/* "honoured", "approximated", "ignored", of PPM_FEATURE_. */
const char *feature_verdict(int32_t verdict);

/* [{"name": ..., "verdict": ..., "note": ...}, ...]: what the file uses. The caller owns it; NULL
 * when memory is out. */
json_t *features_json(const ppm_asset *asset);

/* A string. One that is no UTF-8, as a file's name may be, is taken as Latin-1. The caller owns it;
 * NULL when memory is out. */
json_t *text_json(const char *text);

#endif
