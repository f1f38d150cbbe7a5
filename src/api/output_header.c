/* Picture headers.
 *
 * Nothing in them depends on the time, the machine or the number of threads: the same render writes
 * the same bytes. Chromaticities say what the numbers mean (OpenEXR's standard attribute); programs
 * that do not read them know the name of the space. */
#include "api/output_header.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static ppmi_image_attribute *add(ppmi_output_header *header, const char *name, int32_t type)
{
    assert(header->count < PPMI_OUTPUT_ATTRIBUTES_MAX);
    ppmi_image_attribute *const attribute = &header->attributes[header->count++];
    *attribute = (ppmi_image_attribute){.name = name, .type = type};
    return attribute;
}

ppmi_image_attribute *ppmi_output_header_add(ppmi_output_header *header, const char *name,
                                             int32_t type)
{
    return add(header, name, type);
}

static void add_text(ppmi_output_header *header, const char *name, const char *text)
{
    if (text && *text) add(header, name, PPMI_ATTRIBUTE_STRING)->text = text;
}

static void add_floats(ppmi_output_header *header, const char *name, const float *values,
                       uint32_t count)
{
    const int32_t type = count == 1 ? PPMI_ATTRIBUTE_FLOAT : PPMI_ATTRIBUTE_FLOATS;
    ppmi_image_attribute *const attribute = add(header, name, type);
    attribute->floats = values;
    attribute->float_count = count;
}

/* As text where it does not fit a signed number. */
static void add_count(ppmi_output_header *header, const char *name, uint64_t value)
{
    if (value <= INT64_MAX) {
        add(header, name, PPMI_ATTRIBUTE_INT)->integer = (int64_t)value;
        return;
    }
    assert(header->text_count < PPMI_OUTPUT_COUNTS_MAX);
    char *const text = header->counts[header->text_count++];
    snprintf(text, sizeof header->counts[0], "%" PRIu64, value);
    add_text(header, name, text);
}

static const char *filter_name(int32_t filter)
{
    switch (filter) {
    case PPM_PIXEL_FILTER_BOX:
        return "box";
    case PPM_PIXEL_FILTER_GAUSSIAN:
        return "gaussian";
    }
    return "blackman-harris";
}

/* The camera's part. A pinhole has no focus, whatever was asked for. */
static void write_camera_options(char *text, size_t size, const ppm_render_options *options)
{
    const uint32_t *const crop = options->crop;
    int length = snprintf(text, size,
                          " camera=%" PRIu32 " crop=%" PRIu32 ",%" PRIu32 ",%" PRIu32 ",%" PRIu32
                          " filter=%s,%.9g shutter=%.9g,%.9g",
                          options->camera, crop[0], crop[1], crop[2], crop[3],
                          filter_name(options->pixel_filter), (double)options->pixel_filter_width,
                          (double)options->shutter_open, (double)options->shutter_close);
    if (!isinf(options->aperture_f_number)) {
        snprintf(text + length, size - (size_t)length, " aperture=%.9g focus_m=%.9g",
                 (double)options->aperture_f_number, (double)options->focus_distance_m);
    }
}

/* What the layers hold, where it is not the usual. */
static void write_layer_options(char *text, size_t size, const ppm_render_options *options)
{
    snprintf(text, size, "%s%s%s", options->is_transparent ? " transparent=yes" : "",
             options->normals_of_camera ? " normals=camera" : "",
             options->follows_specular ? " specular=followed" : "");
}

/* All options that shape the picture; the number of threads does not. */
static void write_options(char *text, size_t size, const char *integrator,
                          const ppm_render_options *options)
{
    char camera[256], layers[96];
    write_camera_options(camera, sizeof camera, options);
    write_layer_options(layers, sizeof layers, options);
    snprintf(text, size,
             "integrator=%s width=%" PRIu32 " height=%" PRIu32 " photons_per_pass=%" PRIu64
             " max_depth=%" PRIu32 " radius_m=%.9g alpha=%.9g seed=%" PRIu64
             " schedule=%s direct=%s aim=%s photons_per_epoch=%" PRIu64 " split_depth=%" PRId32
             "%s%s",
             integrator, options->width, options->height, options->photons_per_pass,
             options->max_depth, (double)options->radius_m, (double)options->alpha, options->seed,
             options->schedule == PPM_SCHEDULE_MEMORYLESS ? "memoryless" : "progressive",
             options->direct == PPM_DIRECT_PHOTONS ? "photons" : "sample",
             options->aim == PPM_AIM_EVEN ? "even" : "learnt", options->photons_per_epoch,
             options->split_depth, camera, layers);
}

void ppmi_output_header_init_display(ppmi_output_header *header)
{
    *header = (ppmi_output_header){0};
    snprintf(header->software, sizeof header->software, "ppm-render %s", ppm_version());
    add_text(header, "Software", header->software);
}

void ppmi_output_header_init(ppmi_output_header *header, const ppm_render_options *options,
                             const ppm_render_stats *stats, const char *integrator,
                             const char *camera, const char *command,
                             const ppmi_working_space *space)
{
    static const float square[1] = {1};
    ppmi_output_header_init_display(header);
    write_options(header->options, sizeof header->options, integrator, options);
    add_text(header, "ppm:workingSpace", space->name);
    if (!space->differs) space = &ppmi_working_space_rec709;
    add_floats(header, "chromaticities", space->chromaticities, 8);
    /* OpenImageIO keeps its own attribute for itself: 2.4 calls every OpenEXR file it reads
     * "Linear". The second name is the one that is stored (ASWF Color Interop Forum). */
    if (!space->differs) add_text(header, "oiio:ColorSpace", "lin_rec709");
    add_text(header, "colorInteropID", space->interop_id);
    add_floats(header, "PixelAspectRatio", square, 1);
    add_text(header, "ppm:version", ppm_version());
    add_text(header, "ppm:options", header->options);
    add_text(header, "ppm:integrator", integrator);
    add_count(header, "ppm:passes", stats->passes);
    add_count(header, "ppm:photons", stats->photons_emitted);
    add_count(header, "ppm:seed", options->seed);
    add_text(header, "ppm:camera", camera);
    add_text(header, "ppm:command", command);
}

void ppmi_output_header_add_view(ppmi_output_header *header, const char *source,
                                 const char *display, const char *view, const char *look,
                                 const ppmi_view_choice *choice)
{
    add_text(header, "ppm:colorConfig", source);
    add_text(header, "ppm:display", display);
    add_text(header, "ppm:view", view);
    if (look) add_text(header, "ppm:look", *look ? look : "none");
    add_floats(header, "ppm:exposure", &choice->exposure_ev, 1);
    if (choice->gamma > 0) add_floats(header, "ppm:gamma", &choice->gamma, 1);
}

/* OpenImageIO writes "Copyright" as what each format has for it: "owner" in OpenEXR, the tag in
 * Exif and TIFF, the keyword in PNG. */
void ppmi_output_header_add_origin(ppmi_output_header *header, const char *copyright,
                                   const char *xmp)
{
    add_text(header, "Copyright", copyright);
    add_text(header, "ppm:xmp", xmp);
}

/* The fraction nearest to value: whole rates, and those of NTSC, are exact. */
static void to_rational(double value, int32_t out[2])
{
    static const int32_t denominators[] = {1, 1001, 1000};
    const double most = INT32_MAX / 1001.0;
    out[0] = out[1] = 1;
    for (int i = 0; i < 3; i++) {
        const double numerator = round(fmin(value, most) * denominators[i]);
        out[0] = (int32_t)numerator;
        out[1] = denominators[i];
        if (fabs(numerator / denominators[i] - value) < 1e-5 * value) break;
    }
}

void ppmi_output_header_add_frame(ppmi_output_header *header, int32_t frame,
                                  double frames_per_second)
{
    header->time_s = (float)(frame / frames_per_second);
    add(header, "ppm:frame", PPMI_ATTRIBUTE_INT)->integer = frame;
    add_floats(header, "ppm:time", &header->time_s, 1);
    to_rational(frames_per_second,
                add(header, "framesPerSecond", PPMI_ATTRIBUTE_RATIONAL)->rational);
}
