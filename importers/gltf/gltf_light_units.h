/* What exporters write for the strength of lamps, by their versions (docs/light-units.md). */
#ifndef PPMI_GLTF_LIGHT_UNITS_H
#define PPMI_GLTF_LIGHT_UNITS_H

#include <stdbool.h>
#include <stdint.h>

/* Versions from .. below to of one exporter. */
typedef struct ppmi_gltf_unit_row {
    const char *generator;  /* what asset.generator begins with */
    int32_t from[2], to[2]; /* major, minor */
    int32_t units;          /* PPM_LIGHT_UNITS_ */
    bool suns_are_doubtful; /* a sun of exactly 683 may have lost its strength */
    const char *versions;   /* for people */
} ppmi_gltf_unit_row;

/* The row of a generator; NULL when it is none that breaks the units of KHR_lights_punctual. */
const ppmi_gltf_unit_row *ppmi_gltf_find_units(const char *generator);

/* From the file's number to candela or lux on the renderer's scale. kind: PPMI_GLTF_LIGHT_. */
double ppmi_gltf_unit_factor(int32_t units, int32_t kind);

/* From watts of radiant flux to the same scale. */
double ppmi_gltf_watt_factor(int32_t units);

/* From candela that were measured (light profiles) to the same scale. */
double ppmi_gltf_candela_factor(int32_t units);

#endif
