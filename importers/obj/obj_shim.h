/* tinyobjloader behind a C interface: it reads numbers, faces and materials from statements that
 * obj_lines.c hands to it one at a time, so that whoever receives the result knows the line. C
 * interface of a C++ shim: no exception leaves it. */
#ifndef PPMI_OBJ_SHIM_H
#define PPMI_OBJ_SHIM_H

#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
#define PPMI_NOEXCEPT noexcept
extern "C" {
#else
#define PPMI_NOEXCEPT
#endif

/* Indices as written: from 1, negative from the end, 0 for none. */
typedef struct ppmi_obj_corner {
    int32_t position, uv, normal;
} ppmi_obj_corner;

/* A statement as obj_lines.h gives it; NULL ends the file. */
typedef char *(*ppmi_obj_next_fn)(void *user, size_t *out_length);

/* What happens while a file is read. A call belongs to the statement that next handed out last. */
typedef struct ppmi_obj_events {
    void *user;
    ppmi_obj_next_fn next; /* v, vt, vn and f statements */
    void (*position)(void *user, const float xyz[3]);
    void (*uv)(void *user, const float uv[2]);
    void (*normal)(void *user, const float xyz[3]);
    void (*face)(void *user, const ppmi_obj_corner *corners, size_t count);
} ppmi_obj_events;

/* Reads until next returns NULL. file is for messages. Returns OK, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_obj_parse(ppm_context *context, const char *file,
                          const ppmi_obj_events *events) PPMI_NOEXCEPT;

/* The values of one material; obj_library.c knows which statements there were, and reads maps. */
typedef struct ppmi_obj_mtl {
    float diffuse[3], specular[3], transmittance[3], emission[3];
    float shininess, ior, dissolve, roughness, metallic;
    float sheen, clearcoat, clearcoat_roughness, anisotropy, anisotropy_rotation;
    int32_t illum;
} ppmi_obj_mtl;

/* Reads one material: its statements without newmtl. *out_mtl is valid until destroyed. */
ppm_status ppmi_obj_mtl_create(ppm_context *context, const char *file, ppmi_obj_next_fn next,
                               void *user, ppmi_obj_mtl **out_mtl) PPMI_NOEXCEPT;
void ppmi_obj_mtl_destroy(const ppmi_obj_mtl *mtl) PPMI_NOEXCEPT;

/* Reads up to count numbers that are parted by blanks, in any locale; returns how many there
 * were. */
size_t ppmi_obj_parse_floats(const char *text, size_t length, float *out,
                             size_t count) PPMI_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
