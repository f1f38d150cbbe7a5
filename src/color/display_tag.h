/* What a display-referred picture can say about its code values: primaries and curve of the display
 * that it was made for. */
#ifndef PPMI_COLOR_DISPLAY_TAG_H
#define PPMI_COLOR_DISPLAY_TAG_H

#include "color/color.h"
#include "color/primaries.h"

enum {
    PPMI_CURVE_SRGB,  /* IEC 61966-2-1 */
    PPMI_CURVE_POWER, /* a power, gamma */
    PPMI_CURVE_HDR    /* PQ or HLG: no ICC profile of matrix and curves says them */
};

typedef struct ppmi_display_tag {
    const char *name; /* for people, and in the profile */
    const ppmi_primaries *primaries;
    int32_t curve; /* PPMI_CURVE_ */
    double gamma;
    uint8_t cicp[4]; /* ITU-T H.273; primaries 0: it has none */
    bool is_srgb;
} ppmi_display_tag;

/* By the name of the space that display and view end in, else by the display's: configurations say
 * it in no other way. NULL: unknown, or numbers that are no colours. */
const ppmi_display_tag *ppmi_color_display_tag(const ppm_color *color,
                                               const ppmi_view_choice *choice);

/* The same for a name; display may be NULL. */
const ppmi_display_tag *ppmi_display_tag_of_names(const char *space, const char *display);

#endif
