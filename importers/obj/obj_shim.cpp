// tinyobjloader's callback interface on a stream of single statements.
#include "obj/obj_shim.h"

#include <algorithm>
#include <charconv>
#include <istream>
#include <map>
#include <memory>
#include <new>
#include <streambuf>
#include <string>
#include <vector>

#include <tiny_obj_loader.h>

namespace
{
// A stream in which every refill is one statement: the parser never reads ahead of its callbacks.
class Statements : public std::streambuf
{
  public:
    Statements(ppmi_obj_next_fn next, void *user) : next_(next), user_(user)
    {
    }

  protected:
    int_type underflow() override
    {
        size_t length = 0;
        char *text = next_(user_, &length);
        if (!text) return traits_type::eof();
        setg(text, text, text + length + 1);
        return traits_type::to_int_type(*text);
    }

  private:
    ppmi_obj_next_fn next_;
    void *user_;
};

struct Receiver {
    const ppmi_obj_events *events;
    std::vector<ppmi_obj_corner> corners;
};

const ppmi_obj_events *events_of(void *user)
{
    return static_cast<Receiver *>(user)->events;
}

void receive_position(void *user, float x, float y, float z, float)
{
    const float xyz[3] = {x, y, z};
    events_of(user)->position(events_of(user)->user, xyz);
}

void receive_uv(void *user, float u, float v, float)
{
    const float uv[2] = {u, v};
    events_of(user)->uv(events_of(user)->user, uv);
}

void receive_normal(void *user, float x, float y, float z)
{
    const float xyz[3] = {x, y, z};
    events_of(user)->normal(events_of(user)->user, xyz);
}

void receive_face(void *user, tinyobj::index_t *indices, int count)
{
    auto *receiver = static_cast<Receiver *>(user);
    receiver->corners.clear();
    for (int i = 0; i < count; ++i) {
        receiver->corners.push_back(
            {indices[i].vertex_index, indices[i].texcoord_index, indices[i].normal_index});
    }
    receiver->events->face(receiver->events->user, receiver->corners.data(),
                           receiver->corners.size());
}

void parse(const ppmi_obj_events *events)
{
    Receiver receiver = {events, {}};
    Statements buffer(events->next, events->user);
    std::istream stream(&buffer);
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = receive_position;
    callbacks.texcoord_cb = receive_uv;
    callbacks.normal_cb = receive_normal;
    callbacks.index_cb = receive_face;
    tinyobj::LoadObjWithCallback(stream, callbacks, &receiver);
}

void copy3(const float *from, float *out)
{
    std::copy(from, from + 3, out);
}

ppmi_obj_mtl *copy_material(const tinyobj::material_t &from)
{
    auto m = std::make_unique<ppmi_obj_mtl>();
    copy3(from.diffuse, m->diffuse);
    copy3(from.specular, m->specular);
    copy3(from.transmittance, m->transmittance);
    copy3(from.emission, m->emission);
    m->shininess = from.shininess;
    m->ior = from.ior;
    m->dissolve = from.dissolve;
    m->roughness = from.roughness;
    m->metallic = from.metallic;
    m->sheen = from.sheen;
    m->clearcoat = from.clearcoat_thickness;
    m->clearcoat_roughness = from.clearcoat_roughness;
    m->anisotropy = from.anisotropy;
    m->anisotropy_rotation = from.anisotropy_rotation;
    m->illum = from.illum;
    return m.release();
}

ppmi_obj_mtl *load_material(ppmi_obj_next_fn next, void *user)
{
    Statements buffer(next, user);
    std::istream stream(&buffer);
    std::map<std::string, int> names;
    std::vector<tinyobj::material_t> materials;
    tinyobj::LoadMtl(&names, &materials, &stream, nullptr, nullptr);
    return copy_material(materials.at(0)); // it makes one even of no statements
}

// Runs body; whatever it throws becomes a status.
template <typename Body>
ppm_status guarded(ppm_context *context, const char *file, Body body) noexcept
{
    try {
        body();
        return PPM_STATUS_OK;
    } catch (const std::bad_alloc &) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", file);
    } catch (const std::exception &e) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", file, e.what());
    } catch (...) {
        return ppmi_fail(context, PPM_STATUS_INTERNAL, "%s: unknown error in the OBJ parser", file);
    }
}
} // namespace

ppm_status ppmi_obj_parse(ppm_context *context, const char *file,
                          const ppmi_obj_events *events) noexcept
{
    return guarded(context, file, [&] { parse(events); });
}

ppm_status ppmi_obj_mtl_create(ppm_context *context, const char *file, ppmi_obj_next_fn next,
                               void *user, ppmi_obj_mtl **out_mtl) noexcept
{
    return guarded(context, file, [&] { *out_mtl = load_material(next, user); });
}

void ppmi_obj_mtl_destroy(const ppmi_obj_mtl *mtl) noexcept
{
    delete mtl;
}

size_t ppmi_obj_parse_floats(const char *text, size_t length, float *out, size_t count) noexcept
{
    const char *end = text + length;
    size_t found = 0;
    while (found < count) {
        while (text < end && (*text == ' ' || *text == '\t' || *text == '+')) {
            ++text;
        }
        const auto result = std::from_chars(text, end, out[found]);
        if (result.ec != std::errc()) break;
        text = result.ptr;
        ++found;
    }
    return found;
}
