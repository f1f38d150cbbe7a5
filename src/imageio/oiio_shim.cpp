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
    case PPMI_ATTRIBUTE_MATRIX:
        spec.attribute(attribute.name, OIIO::TypeMatrix, attribute.floats);
        break;
    case PPMI_ATTRIBUTE_PAIR:
        spec.attribute(attribute.name, TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), attribute.floats);
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

/* ---- writing strip by strip ------------------------------------------------------------------ */

/* Bytes on their way to a sink. What it answers is kept: exceptions of OpenEXR do not say it. */
class sink_proxy final : public OIIO::Filesystem::IOProxy
{
  public:
    explicit sink_proxy(const ppmi_oiio_sink &sink) : IOProxy("", IOProxy::Write), m_sink(sink)
    {
    }
    const char *proxytype() const override
    {
        return "sink";
    }
    size_t write(const void *buf, size_t size) override
    {
        const size_t written = pwrite(buf, size, m_pos);
        m_pos += (int64_t)written;
        return written;
    }
    size_t pwrite(const void *buf, size_t size, int64_t offset) override
    {
        if (m_fault == 0) m_fault = m_sink.write(m_sink.user, buf, size, (uint64_t)offset);
        return m_fault == 0 ? size : 0;
    }
    int fault() const
    {
        return m_fault;
    }

  private:
    ppmi_oiio_sink m_sink;
    int m_fault = 0;
};

struct ppmi_oiio_writer {
    sink_proxy proxy;
    std::string sink_path;
    std::vector<ImageSpec> specs;
    std::unique_ptr<ImageOutput> output;

    explicit ppmi_oiio_writer(const ppmi_oiio_sink &sink) : proxy(sink), sink_path(sink.path)
    {
    }
    ~ppmi_oiio_writer()
    {
        if (output) message_of(*output);
    }
};

static ppm_status fail_writer(ppm_context *context, ppmi_oiio_writer &writer, const char *path)
{
    const std::string reason = message_of(*writer.output);
    if (writer.proxy.fault() == 0) {
        return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, "%s: cannot be encoded: %s", path,
                         reason.c_str());
    }
    return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, "%s: cannot be written: %s", path,
                     strerror(writer.proxy.fault()));
}

static ImageSpec spec_of_part(const ppmi_layered_file &file, uint32_t index)
{
    const ppmi_layered_part &part = file.parts[index];
    const uint32_t attribute_count = index == 0 ? file.attribute_count : file.repeated_count;
    ImageSpec spec((int)file.width, (int)file.height, (int)part.channel_count, TypeDesc::FLOAT);
    for (uint32_t i = 0; i < part.channel_count; i++) {
        const ppmi_layered_channel &channel = part.channels[i];
        spec.channelnames[i] = channel.name;
        spec.channelformats.push_back(stored_type(channel.store));
    }
    if (file.full_width > 0) {
        spec.x = (int)file.x;
        spec.y = (int)file.y;
        spec.full_width = (int)file.full_width;
        spec.full_height = (int)file.full_height;
    }
    if (file.tile_side > 0) {
        spec.tile_width = spec.tile_height = (int)file.tile_side;
        spec.tile_depth = 1;
    }
    const char *const compression = part.compression ? part.compression : file.compression;
    if (compression) spec.attribute("compression", compression);
    if (part.name) spec.attribute("oiio:subimagename", part.name);
    spec.attribute("DateTime", "");
    for (uint32_t i = 0; i < attribute_count; i++)
        set_attribute(spec, file.attributes[i]);
    return spec;
}

ppm_status ppmi_oiio_create_layered(ppm_context *context, const char *path,
                                    const ppmi_layered_file *file, const ppmi_oiio_sink *sink,
                                    ppmi_oiio_writer **out_writer) noexcept
{
    return guarded(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, path, [&]() -> ppm_status {
        auto writer = std::make_unique<ppmi_oiio_writer>(*sink);
        for (uint32_t i = 0; i < file->part_count; i++)
            writer->specs.push_back(spec_of_part(*file, i));
        writer->output = ImageOutput::create("openexr");
        if (!writer->output) {
            OIIO::geterror();
            return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE,
                             "%s: this build of OpenImageIO cannot write OpenEXR files", path);
        }
        writer->output->threads(1);
        if (file->part_count == 1) writer->output->set_ioproxy(&writer->proxy);
        *out_writer = writer.release();
        return PPM_STATUS_OK;
    });
}

ppm_status ppmi_oiio_begin_part(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                uint32_t part) noexcept
{
    return guarded(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, path, [&]() -> ppm_status {
        ImageOutput &output = *writer->output;
        const std::vector<ImageSpec> &specs = writer->specs;
        const std::string &sink = writer->sink_path;
        const bool is_open = part > 0 ? output.open(sink, specs[part], ImageOutput::AppendSubimage)
                             : specs.size() == 1
                                 ? output.open(path, specs[0])
                                 : output.open(sink, (int)specs.size(), specs.data());
        return is_open ? PPM_STATUS_OK : fail_writer(context, *writer, path);
    });
}

ppm_status ppmi_oiio_write_rows(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                uint32_t y, uint32_t row_count, const float *values) noexcept
{
    return guarded(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, path, [&]() -> ppm_status {
        ImageOutput &output = *writer->output;
        const ImageSpec &spec = output.spec();
        const int begin = spec.y + (int)y, end = begin + (int)row_count;
        const bool is_written =
            spec.tile_width > 0 ? output.write_tiles(spec.x, spec.x + spec.width, begin, end, 0, 1,
                                                     TypeDesc::FLOAT, values)
                                : output.write_scanlines(begin, end, 0, TypeDesc::FLOAT, values);
        return is_written ? PPM_STATUS_OK : fail_writer(context, *writer, path);
    });
}

ppm_status ppmi_oiio_close_writer(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                  bool is_complete) noexcept
{
    const ppm_status status =
        guarded(context, PPM_STATUS_OUTPUT_NOT_WRITABLE, path, [&]() -> ppm_status {
            /* the offsets of all blocks are written here, where errors are not told */
            const bool is_closed = writer->output->close() && writer->proxy.fault() == 0;
            return is_closed || !is_complete ? PPM_STATUS_OK : fail_writer(context, *writer, path);
        });
    delete writer;
    return status;
}

/* ---- reading parts of OpenEXR files ---------------------------------------------------------- */

struct ppmi_oiio_part {
    std::unique_ptr<ImageInput> input;
    ImageSpec spec;
    int index = 0;
    std::string name;
    std::vector<ppmi_image_attribute> attributes; /* point into spec */
    /* Of files in tiles: the row of tiles that was read last. */
    std::vector<float> band;
    int band_begin = 0, band_end = 0;
};

/* False for what OpenImageIO adds by itself, and for types that are of no use here. */
static bool get_attribute(const OIIO::ParamValue &value, ppmi_image_attribute &out)
{
    const TypeDesc type = value.type();
    const std::string name = value.name().string();
    if (name.compare(0, 5, "oiio:") == 0 || name.compare(0, 8, "openexr:") == 0) return false;
    out = ppmi_image_attribute{};
    out.name = value.name().c_str();
    if (type == TypeDesc::STRING) {
        out.type = PPMI_ATTRIBUTE_STRING;
        out.text = value.get_ustring().c_str();
    } else if (type == TypeDesc::INT || type == TypeDesc::UINT) {
        out.type = PPMI_ATTRIBUTE_INT;
        out.integer = value.get_int();
    } else if (type.vecsemantics == TypeDesc::RATIONAL && type.basetype == TypeDesc::INT) {
        out.type = PPMI_ATTRIBUTE_RATIONAL;
        memcpy(out.rational, value.data(), sizeof out.rational);
    } else if (type.basetype == TypeDesc::FLOAT) {
        out.type = type == TypeDesc::FLOAT                ? PPMI_ATTRIBUTE_FLOAT
                   : type.aggregate == TypeDesc::MATRIX44 ? PPMI_ATTRIBUTE_MATRIX
                   : type.aggregate == TypeDesc::VEC2     ? PPMI_ATTRIBUTE_PAIR
                                                          : PPMI_ATTRIBUTE_FLOATS;
        out.floats = static_cast<const float *>(value.data());
        out.float_count = (uint32_t)(type.numelements() * type.aggregate);
    } else {
        return false;
    }
    return true;
}

static void fill_part(ppmi_oiio_part &part, ppmi_oiio_part_info &info)
{
    const ImageSpec &spec = part.spec;
    info.x = spec.x;
    info.y = spec.y;
    info.width = spec.width;
    info.height = spec.height;
    info.full_x = spec.full_x;
    info.full_y = spec.full_y;
    info.full_width = spec.full_width;
    info.full_height = spec.full_height;
    info.channel_count = spec.nchannels;
    info.part_count = spec.get_int_attribute("oiio:subimages", 1);
    info.is_deep = spec.deep;
    part.name = spec.get_string_attribute("oiio:subimagename", "");
    for (const OIIO::ParamValue &value : spec.extra_attribs) {
        ppmi_image_attribute attribute;
        if (get_attribute(value, attribute)) part.attributes.push_back(attribute);
    }
}

static ppm_status fail_part(ppm_context *context, ppmi_oiio_part &part, const char *path,
                            const char *what)
{
    const std::string reason = message_of(*part.input);
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s: %s", path, what, reason.c_str());
}

ppm_status ppmi_oiio_part_open(ppm_context *context, const char *path, uint32_t index,
                               ppmi_oiio_part **out_part, ppmi_oiio_part_info *out_info) noexcept
{
    return guarded(context, PPM_STATUS_INPUT_INVALID, path, [&]() -> ppm_status {
        auto part = std::make_unique<ppmi_oiio_part>();
        part->index = (int)index;
        part->input = ImageInput::create("openexr");
        if (!part->input) {
            OIIO::geterror();
            return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                             "%s: this build of OpenImageIO cannot read OpenEXR files", path);
        }
        part->input->threads(1);
        if (!part->input->open(path, part->spec)) {
            return fail_part(context, *part, path, "not a usable OpenEXR image");
        }
        part->spec = part->input->spec(part->index);
        fill_part(*part, *out_info);
        *out_part = part.release();
        return PPM_STATUS_OK;
    });
}

/* Rows of tiles come whole; what is asked for is copied out of them. */
static bool read_tiled(ppmi_oiio_part &part, int begin, int end, float *values)
{
    const ImageSpec &spec = part.spec;
    const size_t row_values = (size_t)spec.width * (size_t)spec.nchannels;
    for (int y = begin; y < end; y++, values += row_values) {
        if (y < part.band_begin || y >= part.band_end) {
            const int row = (y - spec.y) / spec.tile_height;
            const int top = spec.y + row * spec.tile_height, bottom = spec.y + spec.height;
            const int next = top + spec.tile_height < bottom ? top + spec.tile_height : bottom;
            part.band.resize(row_values * (size_t)(next - top));
            part.band_begin = part.band_end = 0;
            if (!part.input->read_tiles(part.index, 0, spec.x, spec.x + spec.width, top, next, 0, 1,
                                        0, spec.nchannels, TypeDesc::FLOAT, part.band.data())) {
                return false;
            }
            part.band_begin = top;
            part.band_end = next;
        }
        memcpy(values, part.band.data() + row_values * (size_t)(y - part.band_begin),
               row_values * sizeof *values);
    }
    return true;
}

ppm_status ppmi_oiio_part_read(ppm_context *context, ppmi_oiio_part *part, const char *path,
                               uint32_t y, uint32_t row_count, float *values) noexcept
{
    return guarded(context, PPM_STATUS_INPUT_INVALID, path, [&]() -> ppm_status {
        const ImageSpec &spec = part->spec;
        const int begin = spec.y + (int)y, end = begin + (int)row_count;
        const bool is_read =
            spec.tile_width > 0
                ? read_tiled(*part, begin, end, values)
                : part->input->read_scanlines(part->index, 0, begin, end, 0, 0, spec.nchannels,
                                              TypeDesc::FLOAT, values);
        return is_read ? PPM_STATUS_OK
                       : fail_part(context, *part, path, "the pixels cannot be decoded");
    });
}

const char *ppmi_oiio_part_name(const ppmi_oiio_part *part) noexcept
{
    return part->name.c_str();
}

const char *ppmi_oiio_part_channel(const ppmi_oiio_part *part, int32_t index) noexcept
{
    return part->spec.channelnames[(size_t)index].c_str();
}

uint32_t ppmi_oiio_part_attribute_count(const ppmi_oiio_part *part) noexcept
{
    return (uint32_t)part->attributes.size();
}

const ppmi_image_attribute *ppmi_oiio_part_attribute(const ppmi_oiio_part *part,
                                                     uint32_t index) noexcept
{
    return &part->attributes[index];
}

void ppmi_oiio_part_close(ppmi_oiio_part *part) noexcept
{
    if (!part) return;
    guarded(nullptr, PPM_STATUS_INTERNAL, "", [&] {
        part->input->close();
        message_of(*part->input);
        return PPM_STATUS_OK;
    });
    delete part;
}

const char *ppmi_oiio_version(void) noexcept
{
    return "OpenImageIO " OIIO_VERSION_STRING;
}
