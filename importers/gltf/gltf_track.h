/* Keys over time, and the values between them (glTF 2.0 specification, 3.11 and appendix C). */
#ifndef PPMI_GLTF_TRACK_H
#define PPMI_GLTF_TRACK_H

#include "gltf/gltf_reader.h"

/* What one sampler gives one property. */
typedef struct ppmi_gltf_track {
    int32_t interpolation; /* PPMI_GLTF_LINEAR, _STEP, _CUBICSPLINE */
    bool is_rotation;      /* quaternions: interpolated on the sphere */
    uint32_t width;        /* values at a time */
    size_t key_count;
    double *times;  /* seconds, not decreasing */
    double *values; /* width per key; CUBICSPLINE: in-tangents, values, out-tangents of each key */
} ppmi_gltf_track;

/* What a property takes. */
typedef struct ppmi_gltf_track_format {
    uint32_t width;      /* values at a time */
    uint32_t components; /* of the output accessor; less than width for lists of scalars */
    bool is_rotation;
    bool is_flag; /* on or off: never anything between */
} ppmi_gltf_track_format;

/* Reads a sampler of an animation for a property. place is the channel's JSON path. Free with
 * ppmi_gltf_track_deinit, also after a failure. Returns OK, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_gltf_track_read(ppmi_gltf_reader *reader, int32_t animation, int32_t sampler,
                                const ppmi_gltf_track_format *format, const char *place,
                                ppmi_gltf_track *out_track);
void ppmi_gltf_track_deinit(ppm_context *context, ppmi_gltf_track *track);

/* The values at a time; before the first key and after the last one, those of that key. A time that
 * single precision does not tell from a key's is that of the key, to the bit. */
void ppmi_gltf_track_eval(const ppmi_gltf_track *track, double time_s, double *out_values);

#endif
