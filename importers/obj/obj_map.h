/* Statements of a material that name an image, with options before the name ("MTL material
 * format", Alias|Wavefront, Advanced Visualizer, version 4.2). They are read here, as
 * tinyobjloader knows only some of them, takes the name for a number where an option has fewer
 * numbers than it expects, and has nothing for the clear coat. */
#ifndef PPMI_OBJ_MAP_H
#define PPMI_OBJ_MAP_H

#include "base/context.h"

enum {
    PPMI_OBJ_MAP_KD,
    PPMI_OBJ_MAP_KS,
    PPMI_OBJ_MAP_KE,
    PPMI_OBJ_MAP_NS,
    PPMI_OBJ_MAP_D,
    PPMI_OBJ_MAP_TF,
    PPMI_OBJ_MAP_PR,
    PPMI_OBJ_MAP_PM,
    PPMI_OBJ_MAP_PS,
    PPMI_OBJ_MAP_PC,
    PPMI_OBJ_MAP_PCR,
    PPMI_OBJ_MAP_ANISO,
    PPMI_OBJ_MAP_ANISOR,
    PPMI_OBJ_MAP_NORM,
    PPMI_OBJ_MAP_BUMP,
    PPMI_OBJ_MAP_DISP,
    PPMI_OBJ_MAP_REFL,
    PPMI_OBJ_MAP_COUNT
};

typedef struct ppmi_obj_map {
    char *name; /* UTF-8; NULL: there is no such statement */
    size_t line;
    float offset[2], scale[2];
    float base, gain; /* -mm: values are base + gain * value */
    float bump;       /* -bm */
    char channel;     /* -imfchan: one of r g b m (matte, alpha) l (luminance); 0: not said */
    bool clamp;
    bool is_linear; /* -colorspace linear */
    bool is_sharp;  /* -blendu off -blendv off */
    bool has_turbulence;
    bool has_comma; /* some number had a decimal comma */
} ppmi_obj_map;

/* The PPMI_OBJ_MAP_ of a statement, in any letter case; -1 for what is none. */
int32_t ppmi_obj_map_find(const char *word);
/* The statement as it is written mostly: "map_Kd". */
const char *ppmi_obj_map_word(int32_t map);

/* Reads what follows the word: options, then the name, which is what is left as it stands. An
 * earlier name of *map is freed. False when memory is out. */
bool ppmi_obj_map_read(ppm_context *context, const char *text, size_t length, ppmi_obj_map *map);
/* The same, with options behind the name too: "tex.png -bm 1". */
bool ppmi_obj_map_read_behind(ppm_context *context, const char *text, size_t length,
                              ppmi_obj_map *map);
/* Whether what is left may hold more than the name: an option or a comment. */
bool ppmi_obj_map_may_hold_more(const ppmi_obj_map *map);
void ppmi_obj_map_deinit(ppm_context *context, ppmi_obj_map *map);

static inline bool ppmi_obj_map_is_named(const ppmi_obj_map *map)
{
    return map->name != NULL;
}

/* Whether pixels are used as they are. */
static inline bool ppmi_obj_map_is_plain(const ppmi_obj_map *map)
{
    return !map->name || (map->channel == 0 && map->base == 0.0f && map->gain == 1.0f);
}

#endif
