/* The clear sky and the sun in it, by Preetham, Shirley, Smits 1999. */
#ifndef PPMI_LIGHT_SKY_H
#define PPMI_LIGHT_SKY_H

#include <stdint.h>

#include "math/vec.h"

/* The sun's disk, half of 0.533 degrees. */
#define PPMI_SUN_ANGULAR_RADIUS_RAD 0.00465130f

typedef struct ppmi_sky {
    ppmi_vec3 to_sun;    /* unit */
    float perez[3][5];   /* A .. E of luminance Y and of the chromaticities x and y */
    float normalized[3]; /* Y (nit), x and y at the zenith over their distribution there */
    ppmi_vec3 sun_lux;   /* on a plane that faces the sun, linear Rec.709 */
} ppmi_sky;

/* elevation_rad: 0 .. pi/2; azimuth_rad: clockwise from north (-Z) seen from above, east is +X;
 * turbidity: 2 (very clear) .. 10 (hazy). */
ppmi_sky ppmi_sky_of(float elevation_rad, float azimuth_rad, float turbidity);

/* Radiance of the sky without the sun, nit, linear Rec.709; black below the horizon. */
ppmi_vec3 ppmi_sky_radiance(const ppmi_sky *sky, ppmi_vec3 direction);

/* Illuminance of level ground by the sky without the sun, and by the sun, lux by channel. */
ppmi_vec3 ppmi_sky_ground_lux(const ppmi_sky *sky);
ppmi_vec3 ppmi_sky_sun_ground_lux(const ppmi_sky *sky);

/* Fills a latitude-longitude image (as ppm_environment_desc has it) of 3 * width * height values:
 * the sky above, the even radiance ground below the horizon. */
void ppmi_sky_fill(const ppmi_sky *sky, ppmi_vec3 ground, uint32_t width, uint32_t height,
                   float *pixels);

#endif
