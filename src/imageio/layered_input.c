/* One decoder for each part, so that rows of all parts can be read in turn. */
#include "imageio/layered_input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "imageio/oiio_shim.h"

enum { PARTS_MAX = 4096, CHANNELS_MAX = 16384, SIDE_MAX = 1 << 20 };

typedef struct input_part {
    ppmi_oiio_part *decoder;
    ppmi_oiio_part_info info;
    float *rows; /* of this part alone */
    size_t row_capacity;
} input_part;

struct ppmi_layered_input {
    char *path;
    ppmi_layered_info info;
    input_part *parts;
    char **channel_names;
};

/* ---- opening --------------------------------------------------------------------------------- */

/* Said here, since decoders wait for pipes and call everything "cannot be opened". */
static ppm_status check_file(ppm_context *context, const char *path)
{
    static const unsigned char mark[4] = {0x76, 0x2f, 0x31, 0x01};
    unsigned char begin[4] = {0};
    struct stat facts;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_NOT_FOUND, "%s: cannot be opened: %s", path,
                         strerror(errno));
    }
    const bool is_file = fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode);
    const bool is_exr = is_file && read(descriptor, begin, sizeof begin) == sizeof begin &&
                        memcmp(begin, mark, sizeof mark) == 0;
    close(descriptor);
    if (is_exr) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", path,
                     is_file ? "not an OpenEXR file" : "not a regular file");
}

static bool is_same_window(const ppmi_oiio_part_info *a, const ppmi_oiio_part_info *b)
{
    return a->x == b->x && a->y == b->y && a->width == b->width && a->height == b->height &&
           a->full_width == b->full_width && a->full_height == b->full_height;
}

static ppm_status check_part(ppm_context *context, const char *path, const input_part *part,
                             const input_part *first)
{
    const ppmi_oiio_part_info *const info = &part->info;
    if (info->is_deep) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: deep pixels are not supported",
                         path);
    }
    if (info->width <= 0 || info->height <= 0 || info->full_width <= 0 || info->full_height <= 0 ||
        info->width > SIDE_MAX || info->height > SIDE_MAX || info->channel_count <= 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: an image of %d x %d pixels with %d channels", path, info->width,
                         info->height, info->channel_count);
    }
    if (!is_same_window(info, &first->info)) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: its parts have different sizes or places: %d x %d pixels and %d x %d",
                         path, first->info.width, first->info.height, info->width, info->height);
    }
    return PPM_STATUS_OK;
}

static ppm_status open_parts(ppm_context *context, ppmi_layered_input *input)
{
    uint32_t count = 1;
    for (uint32_t i = 0; i < count; i++) {
        input_part *const part = &input->parts[i];
        ppm_status status =
            ppmi_oiio_part_open(context, input->path, i, &part->decoder, &part->info);
        if (status != PPM_STATUS_OK) return status;
        if (i == 0 && part->info.part_count > 0) count = (uint32_t)part->info.part_count;
        if (count > PARTS_MAX) {
            return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: %u parts", input->path,
                             count);
        }
        input->info.part_count = i + 1;
        status = check_part(context, input->path, part, &input->parts[0]);
        if (status != PPM_STATUS_OK) return status;
        input->info.channel_count += (uint32_t)part->info.channel_count;
    }
    return PPM_STATUS_OK;
}

/* A part's name goes in front of channels that have no layer: "caustics" and "R". The first part is
 * the picture, whatever it is called, and what is called Z is depth. */
static char *name_channel(ppm_context *context, const input_part *part, uint32_t part_index,
                          int32_t channel)
{
    char name[1024];
    const char *const own = ppmi_oiio_part_channel(part->decoder, channel);
    const char *const layer = ppmi_oiio_part_name(part->decoder);
    const bool is_bare = part_index == 0 || strchr(own, '.') || strcmp(own, "Z") == 0 || !*layer;
    snprintf(name, sizeof name, "%s%s%s", is_bare ? "" : layer, is_bare ? "" : ".", own);
    return ppmi_string_copy(context, name);
}

static ppm_status name_channels(ppm_context *context, ppmi_layered_input *input)
{
    const uint32_t count = input->info.channel_count;
    uint32_t at = 0;
    if (count > CHANNELS_MAX) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: %u channels", input->path,
                         count);
    }
    input->channel_names = ppmi_alloc_zeroed(context, count, sizeof *input->channel_names);
    bool has_memory = input->channel_names != NULL;
    for (uint32_t i = 0; i < input->info.part_count; i++) {
        const input_part *const part = &input->parts[i];
        for (int32_t c = 0; c < part->info.channel_count && has_memory; c++) {
            input->channel_names[at] = name_channel(context, part, i, c);
            has_memory = input->channel_names[at++] != NULL;
        }
    }
    if (has_memory) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to read it", input->path);
}

static void take_windows(ppmi_layered_input *input)
{
    const ppmi_oiio_part_info *const first = &input->parts[0].info;
    input->info.width = (uint32_t)first->width;
    input->info.height = (uint32_t)first->height;
    input->info.x = first->x - first->full_x;
    input->info.y = first->y - first->full_y;
    input->info.full_width = (uint32_t)first->full_width;
    input->info.full_height = (uint32_t)first->full_height;
}

ppm_status ppmi_layered_input_open(ppm_context *context, const char *path,
                                   ppmi_layered_input **out_input, ppmi_layered_info *out_info)
{
    ppm_status status = check_file(context, path);
    if (status != PPM_STATUS_OK) return status;
    ppmi_layered_input *const input = ppmi_alloc_zeroed(context, 1, sizeof *input);
    if (input) {
        input->path = ppmi_string_copy(context, path);
        input->parts = ppmi_alloc_zeroed(context, PARTS_MAX, sizeof *input->parts);
    }
    if (!input || !input->path || !input->parts) {
        ppmi_layered_input_close(context, input);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to read it", path);
    }
    status = open_parts(context, input);
    if (status == PPM_STATUS_OK) status = name_channels(context, input);
    if (status != PPM_STATUS_OK) {
        ppmi_layered_input_close(context, input);
        return status;
    }
    take_windows(input);
    *out_input = input;
    *out_info = input->info;
    return PPM_STATUS_OK;
}

void ppmi_layered_input_close(ppm_context *context, ppmi_layered_input *input)
{
    if (!input) return;
    for (uint32_t i = 0; input->channel_names && i < input->info.channel_count; i++)
        ppmi_free(context, input->channel_names[i]);
    for (uint32_t i = 0; input->parts && i < PARTS_MAX; i++) {
        ppmi_oiio_part_close(input->parts[i].decoder);
        ppmi_free(context, input->parts[i].rows);
    }
    ppmi_free(context, input->channel_names);
    ppmi_free(context, input->parts);
    ppmi_free(context, input->path);
    ppmi_free(context, input);
}

/* ---- what is in it --------------------------------------------------------------------------- */

const char *ppmi_layered_input_channel(const ppmi_layered_input *input, uint32_t index)
{
    return input->channel_names[index];
}

uint32_t ppmi_layered_input_attribute_count(const ppmi_layered_input *input)
{
    return ppmi_oiio_part_attribute_count(input->parts[0].decoder);
}

const ppmi_image_attribute *ppmi_layered_input_attribute(const ppmi_layered_input *input,
                                                         uint32_t index)
{
    return ppmi_oiio_part_attribute(input->parts[0].decoder, index);
}

const ppmi_image_attribute *ppmi_layered_input_find(const ppmi_layered_input *input,
                                                    const char *name)
{
    const uint32_t count = ppmi_layered_input_attribute_count(input);
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_image_attribute *const attribute = ppmi_layered_input_attribute(input, i);
        if (strcmp(attribute->name, name) == 0) return attribute;
    }
    return NULL;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static ppm_status read_part(ppm_context *context, ppmi_layered_input *input, input_part *part,
                            uint32_t y, uint32_t row_count)
{
    const size_t count = (size_t)input->info.width * (size_t)part->info.channel_count * row_count;
    if (count > part->row_capacity) {
        ppmi_free(context, part->rows);
        part->row_capacity = 0;
        part->rows = ppmi_alloc(context, count, sizeof *part->rows);
        if (!part->rows) {
            return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory for %u rows",
                             input->path, row_count);
        }
        part->row_capacity = count;
    }
    return ppmi_oiio_part_read(context, part->decoder, input->path, y, row_count, part->rows);
}

ppm_status ppmi_layered_input_read(ppm_context *context, ppmi_layered_input *input, uint32_t y,
                                   uint32_t row_count, float *values)
{
    const size_t pixel_count = (size_t)input->info.width * row_count;
    const size_t stride = input->info.channel_count;
    size_t at = 0;
    if (input->info.part_count == 1) {
        return ppmi_oiio_part_read(context, input->parts[0].decoder, input->path, y, row_count,
                                   values);
    }
    for (uint32_t i = 0; i < input->info.part_count; i++) {
        input_part *const part = &input->parts[i];
        const size_t channels = (size_t)part->info.channel_count;
        const ppm_status status = read_part(context, input, part, y, row_count);
        if (status != PPM_STATUS_OK) return status;
        for (size_t k = 0; k < pixel_count; k++)
            memcpy(values + k * stride + at, part->rows + k * channels, channels * sizeof *values);
        at += channels;
    }
    return PPM_STATUS_OK;
}
