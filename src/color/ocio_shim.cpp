/* The only file that knows OpenColorIO. */
#include "color/ocio_shim.h"

#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>

#include <OpenColorIO/OpenColorIO.h>

namespace OCIO = OCIO_NAMESPACE;

struct ppmi_ocio_config {
    OCIO::ConstConfigRcPtr config;
};

struct ppmi_ocio_conversion {
    OCIO::ConstCPUProcessorRcPtr processor;
};

/* OpenColorIO's messages are long and have line ends. */
static std::string one_line(const char *text)
{
    std::string line;
    for (; *text; text++) {
        const bool is_space = *text == '\n' || *text == '\r' || *text == '\t' || *text == ' ';
        if (!is_space) line += *text;
        if (is_space && !line.empty() && line.back() != ' ') line += ' ';
    }
    while (!line.empty() && line.back() == ' ')
        line.pop_back();
    return line;
}

/* Runs body; what it throws becomes a status and a message. */
template <typename Body>
static ppm_status guarded(ppm_context *context, const char *name, Body body) noexcept
{
    try {
        try {
            body();
            return PPM_STATUS_OK;
        } catch (const std::bad_alloc &) {
            throw;
        } catch (const std::exception &error) { /* OCIO::Exception is one */
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", name,
                             one_line(error.what()).c_str());
        } catch (...) {
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                             "%s: unknown exception in OpenColorIO", name);
        }
    } catch (...) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", name);
    }
}

/* The same for questions about names, whose answer to trouble is "none". */
template <typename Answer, typename Body> static Answer answered(Answer none, Body body) noexcept
{
    try {
        return body();
    } catch (...) {
        return none;
    }
}

/* ---- configurations -------------------------------------------------------------------------- */

/* A library does not print. This is one setting of the whole process: OpenColorIO has no other. */
static void silence_log()
{
    static const bool is_done = [] {
        OCIO::SetLoggingFunction([](const char *) {});
        return true;
    }();
    (void)is_done;
}

static void warn_of_faults(ppm_context *context, const char *name, const OCIO::Config &config)
{
    try {
        config.validate();
    } catch (const OCIO::Exception &error) {
        ppmi_log(context, PPM_LOG_WARNING, "%s: the colour configuration has a fault: %s", name,
                 one_line(error.what()).c_str());
    }
}

static ppmi_ocio_config *wrap(ppm_context *context, const char *name, OCIO::ConstConfigRcPtr config)
{
    warn_of_faults(context, name, *config);
    return new ppmi_ocio_config{config};
}

ppm_status ppmi_ocio_open_file(ppm_context *context, const char *path,
                               ppmi_ocio_config **out_config) noexcept
{
    return guarded(context, path, [&] {
        silence_log();
        *out_config = wrap(context, path, OCIO::Config::CreateFromFile(path));
    });
}

ppm_status ppmi_ocio_open_text(ppm_context *context, const char *text, const char *name,
                               ppmi_ocio_config **out_config) noexcept
{
    return guarded(context, name, [&] {
        silence_log();
        std::istringstream stream(text);
        *out_config = wrap(context, name, OCIO::Config::CreateFromStream(stream));
    });
}

void ppmi_ocio_close(ppmi_ocio_config *config) noexcept
{
    delete config;
}

/* ---- names ----------------------------------------------------------------------------------- */

/* OpenColorIO says "" where there is none. */
static const char *name_or_null(const char *name)
{
    return name && *name ? name : nullptr;
}

uint32_t ppmi_ocio_display_count(const ppmi_ocio_config *config) noexcept
{
    return answered(0u, [&] { return (uint32_t)config->config->getNumDisplays(); });
}

const char *ppmi_ocio_display_name(const ppmi_ocio_config *config, uint32_t index) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] { return name_or_null(config->config->getDisplay((int)index)); });
}

const char *ppmi_ocio_default_display(const ppmi_ocio_config *config) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] { return name_or_null(config->config->getDefaultDisplay()); });
}

uint32_t ppmi_ocio_view_count(const ppmi_ocio_config *config, const char *display) noexcept
{
    return answered(0u, [&] { return (uint32_t)config->config->getNumViews(display); });
}

const char *ppmi_ocio_view_name(const ppmi_ocio_config *config, const char *display,
                                uint32_t index) noexcept
{
    const char *const none = nullptr;
    return answered(none,
                    [&] { return name_or_null(config->config->getView(display, (int)index)); });
}

const char *ppmi_ocio_default_view(const ppmi_ocio_config *config, const char *display) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] { return name_or_null(config->config->getDefaultView(display)); });
}

uint32_t ppmi_ocio_space_count(const ppmi_ocio_config *config) noexcept
{
    return answered(0u, [&] { return (uint32_t)config->config->getNumColorSpaces(); });
}

const char *ppmi_ocio_space_name(const ppmi_ocio_config *config, uint32_t index) noexcept
{
    const char *const none = nullptr;
    return answered(
        none, [&] { return name_or_null(config->config->getColorSpaceNameByIndex((int)index)); });
}

const char *ppmi_ocio_find_space(const ppmi_ocio_config *config, const char *name) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] {
        /* the configuration keeps the space alive after this pointer has gone */
        const OCIO::ConstColorSpaceRcPtr space = config->config->getColorSpace(name);
        return space ? space->getName() : none;
    });
}

uint32_t ppmi_ocio_look_count(const ppmi_ocio_config *config) noexcept
{
    return answered(0u, [&] { return (uint32_t)config->config->getNumLooks(); });
}

const char *ppmi_ocio_look_name(const ppmi_ocio_config *config, uint32_t index) noexcept
{
    const char *const none = nullptr;
    return answered(none,
                    [&] { return name_or_null(config->config->getLookNameByIndex((int)index)); });
}

bool ppmi_ocio_space_is_data(const ppmi_ocio_config *config, const char *name) noexcept
{
    return answered(false, [&] {
        const OCIO::ConstColorSpaceRcPtr space = config->config->getColorSpace(name);
        return space && space->isData();
    });
}

const char *ppmi_ocio_view_space(const ppmi_ocio_config *config, const char *display,
                                 const char *view) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] {
        const char *const name = config->config->getDisplayViewColorSpaceName(display, view);
        const bool is_display = strcmp(name, OCIO::OCIO_VIEW_USE_DISPLAY_NAME) == 0;
        return name_or_null(is_display ? display : name);
    });
}

const char *ppmi_ocio_file_space(const ppmi_ocio_config *config, const char *path) noexcept
{
    const char *const none = nullptr;
    return answered(none, [&] {
        if (config->config->getMajorVersion() < 2) return none;
        size_t rule = 0;
        const char *const name = config->config->getColorSpaceFromFilepath(path, rule);
        const size_t count = config->config->getFileRules()->getNumEntries();
        return rule + 1 < count ? name_or_null(name) : none; /* Default is the last */
    });
}

/* ---- conversions ----------------------------------------------------------------------------- */

/* Linear Rec.709 to ACES2065-1 or, inverse, back. */
static OCIO::GroupTransformRcPtr rec709_to_aces(OCIO::TransformDirection direction)
{
    const OCIO::BuiltinTransformRcPtr to_ap1 = OCIO::BuiltinTransform::Create();
    to_ap1->setStyle("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD");
    to_ap1->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
    const OCIO::BuiltinTransformRcPtr to_ap0 = OCIO::BuiltinTransform::Create();
    to_ap0->setStyle("ACEScg_to_ACES2065-1");
    const OCIO::GroupTransformRcPtr both = OCIO::GroupTransform::Create();
    both->appendTransform(to_ap1);
    both->appendTransform(to_ap0);
    both->setDirection(direction);
    return both;
}

/* Without the fast approximations of log and power: they differ between builds of OpenColorIO, and
 * their error shows in dark gradients at 16 bits. */
static ppmi_ocio_conversion *make_conversion(const ppmi_ocio_config *config,
                                             const OCIO::ConstTransformRcPtr &transform)
{
    const auto flags = (OCIO::OptimizationFlags)(OCIO::OPTIMIZATION_DEFAULT &
                                                 ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW);
    const OCIO::ConstProcessorRcPtr processor = config->config->getProcessor(transform);
    return new ppmi_ocio_conversion{processor->getOptimizedCPUProcessor(flags)};
}

static const char *append_look(const ppmi_ocio_config *config, const char *from, const char *look,
                               const OCIO::GroupTransformRcPtr &group)
{
    if (!look || !*look) return from;
    const char *const to = OCIO::LookTransform::GetLooksResultColorSpace(
        config->config, config->config->getCurrentContext(), look);
    const OCIO::LookTransformRcPtr transform = OCIO::LookTransform::Create();
    transform->setSrc(from);
    transform->setDst(to && *to ? to : from);
    transform->setLooks(look);
    group->appendTransform(transform);
    return transform->getDst();
}

ppm_status ppmi_ocio_make_view(ppm_context *context, const ppmi_ocio_config *config,
                               const char *name, const char *from, const char *display,
                               const char *view, const char *look,
                               ppmi_ocio_conversion **out_conversion) noexcept
{
    return guarded(context, name, [&] {
        const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
        const OCIO::DisplayViewTransformRcPtr to_view = OCIO::DisplayViewTransform::Create();
        const std::string source = append_look(config, from, look, group);
        to_view->setSrc(source.c_str());
        to_view->setDisplay(display);
        to_view->setView(view);
        to_view->setLooksBypass(look != nullptr);
        group->appendTransform(to_view);
        *out_conversion = make_conversion(config, group);
    });
}

ppm_status ppmi_ocio_make_conversion(ppm_context *context, const ppmi_ocio_config *config,
                                     const char *name, ppmi_ocio_space from, ppmi_ocio_space to,
                                     ppmi_ocio_conversion **out_conversion) noexcept
{
    return guarded(context, name, [&] {
        const OCIO::GroupTransformRcPtr group = OCIO::GroupTransform::Create();
        if (from.is_rec709_by_aces) {
            group->appendTransform(rec709_to_aces(OCIO::TRANSFORM_DIR_FORWARD));
        }
        const OCIO::ColorSpaceTransformRcPtr to_space = OCIO::ColorSpaceTransform::Create();
        to_space->setSrc(from.name);
        to_space->setDst(to.name);
        group->appendTransform(to_space);
        if (to.is_rec709_by_aces) {
            group->appendTransform(rec709_to_aces(OCIO::TRANSFORM_DIR_INVERSE));
        }
        *out_conversion = make_conversion(config, group);
    });
}

void ppmi_ocio_conversion_destroy(ppmi_ocio_conversion *conversion) noexcept
{
    delete conversion;
}

ppm_status ppmi_ocio_apply(ppm_context *context, const ppmi_ocio_conversion *conversion,
                           const char *name, float *pixels, size_t pixel_count,
                           uint32_t channels) noexcept
{
    return guarded(context, name, [&] {
        OCIO::PackedImageDesc image(pixels, (long)pixel_count, 1, (long)channels);
        conversion->processor->apply(image);
    });
}

const char *ppmi_ocio_version(void) noexcept
{
    return "OpenColorIO " OCIO_VERSION_FULL_STR;
}
