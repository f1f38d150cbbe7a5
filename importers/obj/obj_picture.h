/* A decoded image file on its way into another image: its pixels with the options of its map. It is
 * in a scene of its own, so that it does not stay in memory. */
#ifndef PPMI_OBJ_PICTURE_H
#define PPMI_OBJ_PICTURE_H

#include "obj/obj_reader.h"

typedef struct ppmi_obj_picture {
    ppm_scene *scene; /* NULL: there is no picture */
    ppm_image_id id;
    ppm_image_info info;
    float mean[4];
    const ppmi_obj_map *map;
    char channel; /* as in the map, or what stands for it; 0: all */
    float *rows;  /* room for two */
} ppmi_obj_picture;

/* Returns what ppm_scene_add_image does; close in any case. */
ppm_status ppmi_obj_picture_open(ppmi_obj_reader *reader, const ppmi_obj_map *map, const char *path,
                                 int32_t role, ppmi_obj_picture *out);
void ppmi_obj_picture_close(ppmi_obj_reader *reader, ppmi_obj_picture *picture);

/* One row of the picture as it is, 4 * width floats: after -imfchan, all three colours are the
 * channel; after -mm, colours are base + gain * colour. */
void ppmi_obj_picture_row(const ppmi_obj_picture *picture, uint32_t row, float *out_rgba);
/* One row of the picture enlarged to width x height, linearly between the middles of pixels. */
void ppmi_obj_picture_row_of(ppmi_obj_picture *picture, uint32_t width, uint32_t height,
                             uint32_t row, float *out_rgba);

#endif
