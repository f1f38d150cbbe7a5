/* Texture lookup: wrap, nearest or bilinear, decode. Decoding comes before filtering, so that
 * filtering is linear in light. */
#include "shading/texture.h"

/* A texel index in 0 .. size - 1 by the wrap mode. */
static uint32_t wrap_index(int64_t i, uint32_t size, int32_t mode)
{
    const int64_t n = size;
    if (mode == PPM_WRAP_CLAMP) return (uint32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    if (mode == PPM_WRAP_MIRROR) {
        int64_t m = i % (2 * n);
        if (m < 0) m += 2 * n;
        return (uint32_t)(m < n ? m : 2 * n - 1 - m);
    }
    int64_t m = i % n;
    if (m < 0) m += n;
    return (uint32_t)m;
}

static ppmi_texel decode_u8(const ppmi_image *image, const uint8_t *p, const float *srgb)
{
    const uint32_t channels = image->channels;
    const uint8_t r = p[0], g = channels >= 3 ? p[1] : p[0], b = channels >= 3 ? p[2] : p[0];
    const float scale = 1.0f / 255.0f;
    const float alpha = channels == 2 ? p[1] * scale : channels == 4 ? p[3] * scale : 1.0f;
    if (image->is_srgb) return (ppmi_texel){srgb[r], srgb[g], srgb[b], alpha};
    return (ppmi_texel){r * scale, g * scale, b * scale, alpha};
}

static ppmi_texel fetch(const ppm_scene *scene, const ppmi_image *image, uint32_t x, uint32_t y)
{
    const size_t at = ((size_t)y * image->width + x) * image->channels;
    if (image->u8) return decode_u8(image, image->u8 + at, scene->srgb_to_linear);
    const float *p = image->f32 + at;
    switch (image->channels) {
    case 1:
        return (ppmi_texel){p[0], p[0], p[0], 1.0f};
    case 2:
        return (ppmi_texel){p[0], p[0], p[0], p[1]};
    case 3:
        return (ppmi_texel){p[0], p[1], p[2], 1.0f};
    default:
        return (ppmi_texel){p[0], p[1], p[2], p[3]};
    }
}

static ppmi_texel mix(ppmi_texel a, ppmi_texel b, float t)
{
    return (ppmi_texel){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
                        a.a + (b.a - a.a) * t};
}

/* Keeps coordinates where floats still have a fraction: beyond, every wrap is arbitrary. */
static float bounded(float x)
{
    return fabsf(x) < 1e7f ? x : 0.0f;
}

ppmi_texel ppmi_texture_lookup(const ppm_scene *scene, const ppm_texture *texture, ppmi_vec2 uv)
{
    const ppmi_image *image = &scene->images[texture->image - 1];
    if (texture->has_transform) {
        const float *m = texture->uv_transform;
        uv = (ppmi_vec2){m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
    }
    const float x = bounded(uv.x) * (float)image->width;
    const float y = bounded(uv.y) * (float)image->height;
    if (texture->filter == PPM_FILTER_NEAREST) {
        return fetch(scene, image, wrap_index((int64_t)floorf(x), image->width, texture->wrap_u),
                     wrap_index((int64_t)floorf(y), image->height, texture->wrap_v));
    }
    const float fx = floorf(x - 0.5f), fy = floorf(y - 0.5f);
    const uint32_t x0 = wrap_index((int64_t)fx, image->width, texture->wrap_u);
    const uint32_t x1 = wrap_index((int64_t)fx + 1, image->width, texture->wrap_u);
    const uint32_t y0 = wrap_index((int64_t)fy, image->height, texture->wrap_v);
    const uint32_t y1 = wrap_index((int64_t)fy + 1, image->height, texture->wrap_v);
    const float tx = x - 0.5f - fx, ty = y - 0.5f - fy;
    return mix(mix(fetch(scene, image, x0, y0), fetch(scene, image, x1, y0), tx),
               mix(fetch(scene, image, x0, y1), fetch(scene, image, x1, y1), tx), ty);
}
