/* Errors as colours of the map "magma" (van der Walt and Smith, 2015, released under CC0):
 * lightness rises evenly, so that equal steps of error look equal, also in grey and to the
 * colour-blind. Every fifteenth of its 256 colours, joined by straight lines, is within 0.011 of
 * the map. */
#include "compare/heat.h"

#include <math.h>
#include <stdlib.h>

#include "imageio/format.h"
#include "imageio/imageio.h"

void ppmi_compare_heat_colour(double share, float rgb[3])
{
    static const float magma[][3] = {
        {0.001462f, 0.000466f, 0.013866f}, {0.035520f, 0.028397f, 0.125209f},
        {0.102815f, 0.063010f, 0.257854f}, {0.191460f, 0.064818f, 0.396152f},
        {0.291366f, 0.064553f, 0.475462f}, {0.384299f, 0.097855f, 0.501002f},
        {0.475780f, 0.134577f, 0.507921f}, {0.569172f, 0.167454f, 0.504105f},
        {0.664915f, 0.198075f, 0.488836f}, {0.761077f, 0.231214f, 0.460162f},
        {0.852126f, 0.276106f, 0.418573f}, {0.925937f, 0.346844f, 0.374959f},
        {0.969680f, 0.446936f, 0.360311f}, {0.989363f, 0.557873f, 0.391671f},
        {0.996580f, 0.668256f, 0.456192f}, {0.996727f, 0.776795f, 0.541039f},
        {0.992440f, 0.884330f, 0.640099f}, {0.987053f, 0.991438f, 0.749504f},
    };
    enum { STEPS = sizeof magma / sizeof magma[0] - 1 };
    const double place = fmin(fmax(share, 0), 1) * STEPS;
    const int below = place < STEPS ? (int)place : STEPS - 1;
    const float weight = (float)(place - below);
    for (int c = 0; c < 3; c++)
        rgb[c] = (1 - weight) * magma[below][c] + weight * magma[below + 1][c];
}

static int by_value(const void *first, const void *second)
{
    const float a = *(const float *)first, b = *(const float *)second;
    return (a > b) - (a < b);
}

double ppmi_compare_heat_top(const float *values, const uint8_t *is_broken, size_t count,
                             float *sorted)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_broken[i]) sorted[kept++] = values[i];
    }
    if (kept == 0) return 0;
    qsort(sorted, kept, sizeof *sorted, by_value);
    return (double)sorted[(kept - 1) - (kept - 1) / 100];
}

static ppm_status write_values(ppm_context *context, const char *path, const float *values,
                               const uint8_t *is_broken, ppmi_image_file *file)
{
    const size_t pixel_count = (size_t)file->width * file->height;
    float *const pixels = ppmi_alloc(context, pixel_count, sizeof *pixels);
    if (!pixels) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    for (size_t i = 0; i < pixel_count; i++)
        pixels[i] = is_broken[i] ? NAN : values[i];
    static const char *const names[] = {"Y"};
    file->channels = 1;
    file->channel_names = names;
    file->pixels = pixels;
    const ppm_status status = ppmi_imageio_write_file(context, path, file);
    ppmi_free(context, pixels);
    return status;
}

static ppm_status write_colours(ppm_context *context, const char *path, const float *values,
                                const uint8_t *is_broken, double top, ppmi_image_file *file)
{
    static const float green[3] = {0, 1, 0}; /* magma has none */
    const size_t pixel_count = (size_t)file->width * file->height;
    float *const pixels = ppmi_alloc(context, pixel_count, 3 * sizeof *pixels);
    if (!pixels) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    for (size_t i = 0; i < pixel_count; i++) {
        float rgb[3];
        ppmi_compare_heat_colour((double)values[i] / top, rgb);
        for (size_t c = 0; c < 3; c++)
            pixels[3 * i + c] = is_broken[i] ? green[c] : rgb[c];
    }
    file->channels = 3;
    file->pixels = pixels;
    const ppm_status status = ppmi_imageio_write_file(context, path, file);
    ppmi_free(context, pixels);
    return status;
}

ppm_status ppmi_compare_heat_write(ppm_context *context, const char *path, const float *values,
                                   const uint8_t *is_broken, uint32_t width, uint32_t height,
                                   double top)
{
    const ppmi_output_format *const format = ppmi_imageio_format_of_output(path);
    ppmi_image_file file = {.width = width, .height = height};
    if (format) file.store = format->usual_store;
    if (format && format->is_scene_linear) {
        return write_values(context, path, values, is_broken, &file);
    }
    return write_colours(context, path, values, is_broken, top, &file);
}
