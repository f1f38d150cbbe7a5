/* OpenColorIO, as far as it is needed: a configuration, its lists of names, and conversions made
 * from it. Which space stands for what is decided in spaces.c; no exception leaves the shim. */
#ifndef PPMI_COLOR_OCIO_SHIM_H
#define PPMI_COLOR_OCIO_SHIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
#define PPMI_NOEXCEPT noexcept
extern "C" {
#else
#define PPMI_NOEXCEPT
#endif

typedef struct ppmi_ocio_config ppmi_ocio_config;
typedef struct ppmi_ocio_conversion ppmi_ocio_conversion;

/* Both return OK, INPUT_INVALID, OUT_OF_MEMORY. A configuration that loads but has faults gets a
 * warning: many in use do, in parts that are not needed. */
ppm_status ppmi_ocio_open_file(ppm_context *context, const char *path,
                               ppmi_ocio_config **out_config) PPMI_NOEXCEPT;
ppm_status ppmi_ocio_open_text(ppm_context *context, const char *text, const char *name,
                               ppmi_ocio_config **out_config) PPMI_NOEXCEPT;
void ppmi_ocio_close(ppmi_ocio_config *config) PPMI_NOEXCEPT;

/* Names are valid until ppmi_ocio_close, NULL when out of range or unknown. */
uint32_t ppmi_ocio_display_count(const ppmi_ocio_config *config) PPMI_NOEXCEPT;
const char *ppmi_ocio_display_name(const ppmi_ocio_config *config, uint32_t index) PPMI_NOEXCEPT;
const char *ppmi_ocio_default_display(const ppmi_ocio_config *config) PPMI_NOEXCEPT;
uint32_t ppmi_ocio_view_count(const ppmi_ocio_config *config, const char *display) PPMI_NOEXCEPT;
const char *ppmi_ocio_view_name(const ppmi_ocio_config *config, const char *display,
                                uint32_t index) PPMI_NOEXCEPT;
const char *ppmi_ocio_default_view(const ppmi_ocio_config *config,
                                   const char *display) PPMI_NOEXCEPT;
uint32_t ppmi_ocio_space_count(const ppmi_ocio_config *config) PPMI_NOEXCEPT;
const char *ppmi_ocio_space_name(const ppmi_ocio_config *config, uint32_t index) PPMI_NOEXCEPT;
/* The space of that name, alias or role. */
const char *ppmi_ocio_find_space(const ppmi_ocio_config *config, const char *name) PPMI_NOEXCEPT;

uint32_t ppmi_ocio_look_count(const ppmi_ocio_config *config) PPMI_NOEXCEPT;
const char *ppmi_ocio_look_name(const ppmi_ocio_config *config, uint32_t index) PPMI_NOEXCEPT;
/* Whether the space holds numbers that are no colours. */
bool ppmi_ocio_space_is_data(const ppmi_ocio_config *config, const char *name) PPMI_NOEXCEPT;
/* The space that a display and view end in, as the configuration calls it. */
const char *ppmi_ocio_view_space(const ppmi_ocio_config *config, const char *display,
                                 const char *view) PPMI_NOEXCEPT;
/* The space that the configuration's own rules give a file, by a rule other than Default; NULL:
 * none applies. Configurations of version 1 have no rules. */
const char *ppmi_ocio_file_space(const ppmi_ocio_config *config, const char *path) PPMI_NOEXCEPT;

/* From a space to a display and view. look: NULL for the view's own, else in place of it ("" for
 * none). Returns OK, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_ocio_make_view(ppm_context *context, const ppmi_ocio_config *config,
                               const char *name, const char *from, const char *display,
                               const char *view, const char *look,
                               ppmi_ocio_conversion **out_conversion) PPMI_NOEXCEPT;

/* A space of the configuration or, where is_rec709_by_aces, linear Rec.709 told by the ACES2065-1
 * of that name. */
typedef struct ppmi_ocio_space {
    const char *name;
    bool is_rec709_by_aces;
} ppmi_ocio_space;

/* From one space to another. Returns the same. */
ppm_status ppmi_ocio_make_conversion(ppm_context *context, const ppmi_ocio_config *config,
                                     const char *name, ppmi_ocio_space from, ppmi_ocio_space to,
                                     ppmi_ocio_conversion **out_conversion) PPMI_NOEXCEPT;
void ppmi_ocio_conversion_destroy(ppmi_ocio_conversion *conversion) PPMI_NOEXCEPT;

/* Converts pixel_count packed pixels of 3 or 4 channels in place. Any thread.
 * Returns OK, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_ocio_apply(ppm_context *context, const ppmi_ocio_conversion *conversion,
                           const char *name, float *pixels, size_t pixel_count,
                           uint32_t channels) PPMI_NOEXCEPT;

/* "OpenColorIO 2.1.2". Static. */
const char *ppmi_ocio_version(void) PPMI_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#undef PPMI_NOEXCEPT

#endif
