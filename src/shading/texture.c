/* Texture lookup: wrap, nearest or bilinear, decode. Decoding comes before filtering, so that
 * filtering is linear in light.
 *
 * What covers several texels is looked up in the mipmaps: the footprint's shorter axis chooses the
 * level, between two of which values are mixed (trilinear; Williams 1983), and several such
 * look-ups are spread over its longer axis (Barkans 1997, "High Quality Rendering Using the
 * Talisman Architecture"; McCormack et al. 1999, "Feline"). */
#include "shading/texture.h"

#include "scene/mipmap.h"

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

static ppmi_texel fetch(const ppm_scene *scene, const ppmi_image *image,
                        const ppmi_image_level *level, uint32_t x, uint32_t y)
{
    const size_t at = ((size_t)y * level->width + x) * image->channels;
    if (level->u8) return decode_u8(image, level->u8 + at, scene->srgb_to_linear);
    const float *p = level->f32 + at;
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

/* uv by the texture's transform; of a step only the linear part. */
static ppmi_vec2 transformed(const ppm_texture *texture, ppmi_vec2 uv, float origin)
{
    if (!texture->has_transform) return uv;
    const float *m = texture->uv_transform;
    return (ppmi_vec2){m[0] * uv.x + m[1] * uv.y + origin * m[2],
                       m[3] * uv.x + m[4] * uv.y + origin * m[5]};
}

static ppmi_texel nearest(const ppm_scene *scene, const ppm_texture *texture,
                          const ppmi_image *image, ppmi_vec2 uv)
{
    const ppmi_image_level level = ppmi_image_level_at(image, 0);
    const float x = bounded(uv.x) * (float)level.width, y = bounded(uv.y) * (float)level.height;
    return fetch(scene, image, &level, wrap_index((int64_t)floorf(x), level.width, texture->wrap_u),
                 wrap_index((int64_t)floorf(y), level.height, texture->wrap_v));
}

static ppmi_texel bilinear(const ppm_scene *scene, const ppm_texture *texture,
                           const ppmi_image *image, uint32_t index, ppmi_vec2 uv)
{
    const ppmi_image_level level = ppmi_image_level_at(image, index);
    const float x = bounded(uv.x) * (float)level.width, y = bounded(uv.y) * (float)level.height;
    const float fx = floorf(x - 0.5f), fy = floorf(y - 0.5f);
    const uint32_t x0 = wrap_index((int64_t)fx, level.width, texture->wrap_u);
    const uint32_t x1 = wrap_index((int64_t)fx + 1, level.width, texture->wrap_u);
    const uint32_t y0 = wrap_index((int64_t)fy, level.height, texture->wrap_v);
    const uint32_t y1 = wrap_index((int64_t)fy + 1, level.height, texture->wrap_v);
    const float tx = x - 0.5f - fx, ty = y - 0.5f - fy;
    return mix(mix(fetch(scene, image, &level, x0, y0), fetch(scene, image, &level, x1, y0), tx),
               mix(fetch(scene, image, &level, x0, y1), fetch(scene, image, &level, x1, y1), tx),
               ty);
}

static ppmi_texel finest(const ppm_scene *scene, const ppm_texture *texture,
                         const ppmi_image *image, ppmi_vec2 uv)
{
    return texture->filter == PPM_FILTER_NEAREST ? nearest(scene, texture, image, uv)
                                                 : bilinear(scene, texture, image, 0, uv);
}

/* A matrix may follow the filter: both are linear. */
static ppmi_texel in_working_space(const ppm_scene *scene, const ppmi_image *image,
                                   ppmi_texel texel)
{
    if (!image->is_rec709) return texel;
    float rgb[3] = {texel.r, texel.g, texel.b};
    ppmi_working_light(&scene->working, rgb, rgb);
    return (ppmi_texel){rgb[0], rgb[1], rgb[2], texel.a};
}

ppmi_texel ppmi_texture_lookup(const ppm_scene *scene, const ppm_texture *texture, ppmi_vec2 uv)
{
    const ppmi_image *image = &scene->images[texture->image - 1];
    return in_working_space(scene, image,
                            finest(scene, texture, image, transformed(texture, uv, 1.0f)));
}

/* ---- footprints ------------------------------------------------------------------------------ */

enum { MAX_TAPS = 16 };

/* The ellipse of a footprint, in texels. */
typedef struct ellipse {
    float longer, shorter; /* axes, as large as the parallelogram's sides where it is a rectangle */
    ppmi_vec2 direction;   /* unit, of the longer axis */
} ellipse;

/* The singular values of the steps' matrix and the direction that belongs to the greater one: S =
 * A A^T has their squares as eigenvalues. */
static ellipse ellipse_of(ppmi_vec2 dx, ppmi_vec2 dy)
{
    const float p = dx.x * dx.x + dy.x * dy.x, r = dx.y * dx.y + dy.y * dy.y;
    const float q = dx.x * dx.y + dy.x * dy.y;
    const float half = 0.5f * (p - r), root = sqrtf(half * half + q * q);
    const float longer = sqrtf(0.5f * (p + r) + root);
    /* of the two forms of the eigenvector, the one that does not cancel */
    ppmi_vec2 v = half >= 0.0f ? (ppmi_vec2){half + root, q} : (ppmi_vec2){q, root - half};
    const float length = sqrtf(v.x * v.x + v.y * v.y);
    v = length > 0.0f ? (ppmi_vec2){v.x / length, v.y / length} : (ppmi_vec2){1.0f, 0.0f};
    return (ellipse){longer, fabsf(dx.x * dy.y - dx.y * dy.x) / longer, v};
}

static ppmi_texel trilinear(const ppm_scene *scene, const ppm_texture *texture,
                            const ppmi_image *image, float level, ppmi_vec2 uv)
{
    if (!(level > 0.0f)) return finest(scene, texture, image, uv);
    if (level >= (float)image->mip_count) {
        return bilinear(scene, texture, image, image->mip_count, uv);
    }
    const uint32_t below = (uint32_t)level;
    const ppmi_texel fine =
        below == 0 ? finest(scene, texture, image, uv) : bilinear(scene, texture, image, below, uv);
    return mix(fine, bilinear(scene, texture, image, below + 1, uv), level - (float)below);
}

/* The mean of taps along the longer axis, each as broad as the shorter one. */
static ppmi_texel along_axis(const ppm_scene *scene, const ppm_texture *texture,
                             const ppmi_image *image, const ellipse *e, ppmi_vec2 uv)
{
    const float breadth = ppmi_max(ppmi_max(e->shorter, e->longer / MAX_TAPS), 1.0f);
    const uint32_t taps = (uint32_t)ceilf(ppmi_min(e->longer / breadth, MAX_TAPS));
    const float level = log2f(breadth), share = 1.0f / (float)taps;
    const float step_u = e->direction.x * e->longer / (float)image->width;
    const float step_v = e->direction.y * e->longer / (float)image->height;
    ppmi_texel sum = {0};
    for (uint32_t i = 0; i < taps; i++) {
        const float t = ((float)i + 0.5f) * share - 0.5f;
        const ppmi_vec2 at = {uv.x + t * step_u, uv.y + t * step_v};
        const ppmi_texel texel = trilinear(scene, texture, image, level, at);
        sum = (ppmi_texel){sum.r + texel.r, sum.g + texel.g, sum.b + texel.b, sum.a + texel.a};
    }
    return (ppmi_texel){sum.r * share, sum.g * share, sum.b * share, sum.a * share};
}

static ppmi_texel filtered(const ppm_scene *scene, const ppm_texture *texture,
                           const ppmi_image *image, ppmi_vec2 uv, ppmi_vec2 uv_dx, ppmi_vec2 uv_dy)
{
    const float width = (float)image->width, height = (float)image->height;
    ppmi_vec2 dx = transformed(texture, uv_dx, 0.0f), dy = transformed(texture, uv_dy, 0.0f);
    dx = (ppmi_vec2){dx.x * width, dx.y * height};
    dy = (ppmi_vec2){dy.x * width, dy.y * height};
    uv = transformed(texture, uv, 1.0f);
    const float extent2 = dx.x * dx.x + dx.y * dx.y + dy.x * dy.x + dy.y * dy.y;
    if (image->mip_count == 0 || !(extent2 > 1.0f)) return finest(scene, texture, image, uv);
    if (!(extent2 < 1e24f)) return bilinear(scene, texture, image, image->mip_count, uv);
    const ellipse e = ellipse_of(dx, dy);
    return along_axis(scene, texture, image, &e, uv);
}

ppmi_texel ppmi_texture_filtered(const ppm_scene *scene, const ppm_texture *texture, ppmi_vec2 uv,
                                 ppmi_vec2 uv_dx, ppmi_vec2 uv_dy)
{
    const ppmi_image *image = &scene->images[texture->image - 1];
    return in_working_space(scene, image, filtered(scene, texture, image, uv, uv_dx, uv_dy));
}
