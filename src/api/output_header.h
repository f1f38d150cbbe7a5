/* What the header of a scene-linear picture says about it. */
#ifndef PPMI_API_OUTPUT_HEADER_H
#define PPMI_API_OUTPUT_HEADER_H

#include "color/color.h"
#include "imageio/imageio.h"
#include "ppm/render.h"

enum { PPMI_OUTPUT_ATTRIBUTES_MAX = 64, PPMI_OUTPUT_COUNTS_MAX = 4 };

/* Attributes, with the texts that they point to: must not be copied or moved. */
typedef struct ppmi_output_header {
    ppmi_image_attribute attributes[PPMI_OUTPUT_ATTRIBUTES_MAX];
    uint32_t count;
    uint32_t repeated_count; /* of the first that all parts of a file are to have; the others may be
                                long */
    char software[32];
    char options[1024];
    float time_s;
    char counts[PPMI_OUTPUT_COUNTS_MAX][24];
    uint32_t text_count; /* of counts */
} ppmi_output_header;

/* camera and command may be NULL; the texts, and space, must outlive header. */
void ppmi_output_header_init(ppmi_output_header *header, const ppm_render_options *options,
                             const ppm_render_stats *stats, const char *integrator,
                             const char *camera, const char *command,
                             const ppmi_working_space *space);

/* Adds what the picture is to be seen by: the configuration, names as it writes them, and the
 * choice's numbers. look may be NULL: the view's own. All must outlive header. */
void ppmi_output_header_add_view(ppmi_output_header *header, const char *source,
                                 const char *display, const char *view, const char *look,
                                 const ppmi_view_choice *choice);

/* One more attribute, to be filled in. */
ppmi_image_attribute *ppmi_output_header_add(ppmi_output_header *header, const char *name,
                                             int32_t type);

/* Adds which frame it is. frames_per_second is above 0. */
void ppmi_output_header_add_frame(ppmi_output_header *header, int32_t frame,
                                  double frames_per_second);

/* Adds whose the scene is, and what its file says about it. Either may be NULL or "". */
void ppmi_output_header_add_origin(ppmi_output_header *header, const char *copyright,
                                   const char *xmp);

/* What files of other kinds carry as well. */
void ppmi_output_header_init_display(ppmi_output_header *header);

#endif
