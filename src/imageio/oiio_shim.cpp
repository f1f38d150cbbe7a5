/* The only file that knows OpenImageIO. */
#include "imageio/oiio_shim.h"

#include <climits>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/* Bytes in memory under a name in the file system, for decoders that know nothing else (HEIF). */
class memory_file
{
  public:
    memory_file() = default;
    memory_file(const memory_file &) = delete;
    memory_file &operator=(const memory_file &) = delete;
    ~memory_file()
    {
        if (descriptor >= 0) close(descriptor);
    }

    bool write(const void *data, size_t size)
    {
        descriptor = memfd_create("image", MFD_CLOEXEC);
        if (descriptor < 0) return false;
        const char *bytes = static_cast<const char *>(data);
        while (size > 0) {
            const ssize_t written = ::write(descriptor, bytes, size);
            if (written <= 0) return false;
            bytes += written;
            size -= (size_t)written;
        }
        return true;
    }

    std::string path() const
    {
        return "/proc/self/fd/" + std::to_string(descriptor);
    }

  private:
    int descriptor = -1;
};

/* Members are destroyed from the last to the first: the input goes before what it reads from. */
struct ppmi_oiio_reader {
    OIIO::Filesystem::IOMemReader bytes;
    memory_file file;
    std::unique_ptr<ImageInput> input;

    ppmi_oiio_reader(const void *data, size_t size) : bytes(data, size)
    {
    }
};

/* Runs body; what it throws becomes a status and a message. */
template <typename Body>
static ppm_status guarded(ppm_context *context, ppm_status failure, const char *name,
                          Body body) noexcept
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", name);
    } catch (const std::exception &error) {
        return ppmi_fail(context, failure, "%s: %s", name, error.what());
    } catch (...) {
        return ppmi_fail(context, failure, "%s: unknown exception in OpenImageIO", name);
    }
}

/* OpenImageIO's message on one line. It must always be fetched: an object that is destroyed with
 * an unread message prints it. */
template <typename Object> static std::string message_of(Object &object)
{
    std::string text = object.geterror();
    while (!text.empty() && (text.back() == '\n' || text.back() == ' '))
        text.pop_back();
    for (char &letter : text) {
        if (letter == '\n') letter = ';';
    }
    return text.empty() ? "OpenImageIO gives no reason" : text;
}

/* ---- reading --------------------------------------------------------------------------------- */

static void fill_info(const ImageSpec &spec, ppmi_oiio_info *info)
{
    info->x = spec.x;
    info->y = spec.y;
    info->width = spec.width;
    info->height = spec.height;
    info->full_x = spec.full_x;
    info->full_y = spec.full_y;
    info->full_width = spec.full_width;
    info->full_height = spec.full_height;
    info->channels = spec.nchannels;
    info->alpha_channel = spec.alpha_channel;
    info->is_u8 = spec.format == TypeDesc::UINT8;
    info->is_float = spec.format.is_floating_point();
    info->is_associated = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
    info->is_deep = spec.deep;
    info->has_chromaticities =
        spec.getattribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), info->chromaticities);
    const std::string space = spec.get_string_attribute("colorInteropID").substr(0, 63);
    memcpy(info->color_space, space.c_str(), space.size() + 1);
}

static ppm_status open_reader(ppm_context *context, const char *format, const void *bytes,
                              size_t byte_count, const char *name, ppmi_oiio_reader **out_reader,
                              ppmi_oiio_info *out_info)
{
    auto reader = std::make_unique<ppmi_oiio_reader>(bytes, byte_count);
    reader->input = ImageInput::create(format);
    if (!reader->input) {
        OIIO::geterror();
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: this build of OpenImageIO cannot read %s files", name, format);
    }
    ImageInput &input = *reader->input;
    input.threads(1); /* the caller decides about threads */
    std::string path = name;
    if (input.supports("ioproxy")) {
        input.set_ioproxy(&reader->bytes);
    } else if (reader->file.write(bytes, byte_count)) {
        path = reader->file.path();
    } else {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no room for a copy of the file",
                         name);
    }
    ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input.open(path, spec, config)) {
        const std::string reason = message_of(input);
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: not a usable %s image: %s", name,
                         format, reason.c_str());
    }
    fill_info(spec, out_info);
    *out_reader = reader.release();
    return PPM_STATUS_OK;
}

ppm_status ppmi_oiio_open(ppm_context *context, const char *format, const void *bytes,
                          size_t byte_count, const char *name, ppmi_oiio_reader **out_reader,
                          ppmi_oiio_info *out_info) noexcept
{
    return guarded(context, PPM_STATUS_INPUT_INVALID, name, [&] {
        return open_reader(context, format, bytes, byte_count, name, out_reader, out_info);
    });
}

const char *ppmi_oiio_channel_name(const ppmi_oiio_reader *reader, int32_t index) noexcept
{
    const std::vector<std::string> &names = reader->input->spec().channelnames;
    return index >= 0 && (size_t)index < names.size() ? names[(size_t)index].c_str() : "";
}

ppm_status ppmi_oiio_read(ppm_context *context, ppmi_oiio_reader *reader, const char *name,
                          int32_t first, int32_t channels, bool as_u8, void *out_pixels) noexcept
{
    return guarded(context, PPM_STATUS_INPUT_INVALID, name, [&]() -> ppm_status {
        const TypeDesc type = as_u8 ? TypeDesc::UINT8 : TypeDesc::FLOAT;
        if (reader->input->read_image(0, 0, first, first + channels, type, out_pixels)) {
            return PPM_STATUS_OK;
        }
        const std::string reason = message_of(*reader->input);
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: the pixels cannot be decoded: %s",
                         name, reason.c_str());
    });
}

void ppmi_oiio_close(ppmi_oiio_reader *reader) noexcept
{
    if (!reader) return;
    guarded(nullptr, PPM_STATUS_INTERNAL, "", [&] {
        reader->input->close();
        message_of(*reader->input);
        return PPM_STATUS_OK;
    });
    delete reader;
}

/* ---- writing --------------------------------------------------------------------------------- */

static TypeDesc stored_type(int32_t store)
{
    switch (store) {
    case PPMI_STORE_U8:
        return TypeDesc::UINT8;
    case PPMI_STORE_U16:
        return TypeDesc::UINT16;
    case PPMI_STORE_HALF:
        return TypeDesc::HALF;
    }
    return TypeDesc::FLOAT;
}

/* The type of pixels in memory. */
static TypeDesc given_type(int32_t store)
{
    const TypeDesc type = stored_type(store);
    return type.is_floating_point() ? TypeDesc(TypeDesc::FLOAT) : type;
}

static void set_attribute(ImageSpec &spec, const ppmi_image_attribute &attribute)
{
    switch (attribute.type) {
    case PPMI_ATTRIBUTE_STRING:
        spec.attribute(attribute.name, attribute.text);
        break;
    case PPMI_ATTRIBUTE_INT:
        if (attribute.integer >= INT_MIN && attribute.integer <= INT_MAX) {
            spec.attribute(attribute.name, (int)attribute.integer);
        } else {
            spec.attribute(attribute.name, std::to_string(attribute.integer));
        }
        break;
    case PPMI_ATTRIBUTE_FLOAT:
        spec.attribute(attribute.name, attribute.floats[0]);
        break;
    case PPMI_ATTRIBUTE_FLOATS:
        spec.attribute(attribute.name, TypeDesc(TypeDesc::FLOAT, (int)attribute.float_count),
                       attribute.floats);
        break;
    case PPMI_ATTRIBUTE_RATIONAL:
        spec.attribute(attribute.name, TypeDesc(TypeDesc::INT, TypeDesc::VEC2, TypeDesc::RATIONAL),
                       attribute.rational);
        break;
    }
}

static ImageSpec make_spec(const ppmi_image_file &file, const char *compression)
{
    ImageSpec spec((int)file.width, (int)file.height, (int)file.channels, stored_type(file.store));
    if (file.channels == 2) { /* OpenImageIO has no names for these of its own */
        spec.channelnames = {"Y", "A"};
        spec.alpha_channel = 1;
    }
    if (file.channel_names) {
        for (uint32_t i = 0; i < file.channels; i++)
            spec.channelnames[i] = file.channel_names[i];
    }
    if (file.full_width > 0) {
        spec.x = (int)file.x;
        spec.y = (int)file.y;
        spec.full_width = (int)file.full_width;
        spec.full_height = (int)file.full_height;
    }
    if (compression) spec.attribute("compression", compression);
    if (!spec.format.is_floating_point()) spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("jpeg:subsampling", "4:4:4");
    spec.attribute("DateTime", ""); /* else the time of writing: equal pictures, unequal files */
    if (file.color_space) spec.attribute("oiio:ColorSpace", file.color_space);
    if (file.icc) {
        spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, (int)file.icc_bytes), file.icc);
    }
    for (uint32_t i = 0; i < file.attribute_count; i++)
        set_attribute(spec, file.attributes[i]);
    return spec;
}

static ppm_status fail_output(ppm_context *context, const char *path, ImageOutput &output)
{
    const std::string reason = message_of(output);
    return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, "%s: cannot be encoded: %s", path,
                     reason.c_str());
}

static ppm_status encode(ppm_context *context, const char *format, const char *compression,
                         const char *path, const ppmi_image_file &file, const void *pixels,
                         void **out_bytes, size_t *out_byte_count)
{
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput sink(encoded);
    const std::unique_ptr<ImageOutput> output = ImageOutput::create(format);
    if (!output) {
        OIIO::geterror();
        return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE,
                         "%s: this build of OpenImageIO cannot write %s files", path, format);
    }
    output->threads(1);
    output->set_ioproxy(&sink);
    if (!output->open(path, make_spec(file, compression)) ||
        !output->write_image(given_type(file.store), pixels) || !output->close()) {
        return fail_output(context, path, *output);
    }
    void *const bytes = ppmi_alloc(context, encoded.size(), 1);
    if (!bytes) throw std::bad_alloc();
    memcpy(bytes, encoded.data(), encoded.size());
    *out_bytes = bytes;
    *out_byte_count = encoded.size();
    return PPM_STATUS_OK;
}

ppm_status ppmi_oiio_encode(ppm_context *context, const char *format, const char *compression,
                            const char *path, const ppmi_image_file *file, const void *pixels,
                            void **out_bytes, size_t *out_byte_count) noexcept
{
    return guarded(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, path, [&] {
        return encode(context, format, compression, path, *file, pixels, out_bytes, out_byte_count);
    });
}

const char *ppmi_oiio_version(void) noexcept
{
    return "OpenImageIO " OIIO_VERSION_STRING;
}
