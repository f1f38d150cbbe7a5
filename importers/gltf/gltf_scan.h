/* Looking up values in JSON text that has been checked (gltf_check.h): for what is shown to people
 * but not rendered, such as the names of animations. Each look-up walks over the value that it is
 * in. */
#ifndef PPMI_GLTF_SCAN_H
#define PPMI_GLTF_SCAN_H

#include "gltf/gltf_json.h"

/* The whole text, as the value of its root. */
ppmi_gltf_span ppmi_gltf_scan_root(size_t length);

/* The value of a key of an object; empty (begin == end) when there is none, or value is no object.
 * Keys are compared as they are written. */
ppmi_gltf_span ppmi_gltf_scan_member(const char *text, ppmi_gltf_span value, const char *key);

/* The same for count keys, in one walk. */
void ppmi_gltf_scan_members(const char *text, ppmi_gltf_span value, const char *const *keys,
                            size_t count, ppmi_gltf_span *out_values);

/* The elements of an array, one after the other: *cursor begins as 0. False after the last, and
 * when value is no array. */
bool ppmi_gltf_scan_next(const char *text, ppmi_gltf_span value, size_t *cursor,
                         ppmi_gltf_span *out_element);

/* The number that value is, or otherwise. */
double ppmi_gltf_scan_number(const char *text, ppmi_gltf_span value, double otherwise);

/* Decodes the string that value is into buffer, cut to size with a zero at its end; "" when it is
 * no string. Returns buffer. */
const char *ppmi_gltf_scan_string(const char *text, ppmi_gltf_span value, char *buffer,
                                  size_t size);

#endif
