/* Khronos PBR Neutral: Khronos 3D Commerce 2024, "PBR Neutral Tone Mapper" (the specification's
 * formula). Base colours below 0.8 come out as they are, less the 4 % that a surface reflects of
 * white surroundings; above, the peak is compressed to 1 and highlights fade to white.
 *
 * AgX: Sobotka's picture formation, its contrast curve as the polynomial, and its inset and outset
 * as the matrices of Wrensch 2023, "Minimal AgX Implementation", for Rec.709. The curve is a fit
 * (mean square error 3.7e-6); its code values are for a display of gamma 2.2. */
#include "color/tone.h"

#include <math.h>
#include <string.h>

static void neutral(float rgb[3])
{
    const float reflected = 0.04f, start = 0.8f - reflected, desaturation = 0.15f;
    const float least = fminf(rgb[0], fminf(rgb[1], rgb[2]));
    const float offset =
        least < 2 * reflected ? least - least * least / (4 * reflected) : reflected;
    for (int i = 0; i < 3; i++)
        rgb[i] -= offset;
    const float peak = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    if (peak < start) return;
    const float room = 1 - start;
    const float new_peak = 1 - room * room / (peak + room - start);
    const float white = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    for (int i = 0; i < 3; i++)
        rgb[i] += (new_peak / peak - 1) * rgb[i];
    for (int i = 0; i < 3; i++)
        rgb[i] += (new_peak - rgb[i]) * white;
}

/* Not-a-number and what is below 0, of a filter's lobes or outside of Rec.709, is no light. */
static void make_light(float rgb[3])
{
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] > 0 ? fminf(rgb[i], 1e30f) : 0;
}

void ppmi_tone_neutral(float *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++) {
        make_light(rgba + 4 * i);
        neutral(rgba + 4 * i);
    }
}

static void multiply(const float m[9], float v[3])
{
    const float x = v[0], y = v[1], z = v[2];
    for (int i = 0; i < 3; i++)
        v[i] = m[3 * i] * x + m[3 * i + 1] * y + m[3 * i + 2] * z;
}

/* Horner's form of the fit. */
static float agx_contrast(float x)
{
    return -0.00232f +
           x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
}

static void agx(float rgb[3])
{
    static const float inset[9] = {0.842479062253094f,  0.0784335999999992f, 0.0792237451477643f,
                                   0.0423282422610123f, 0.878468636469772f,  0.0791661274605434f,
                                   0.0423756549057051f, 0.0784336f,          0.879142973793104f};
    static const float outset[9] = {
        1.19687900512017f,    -0.0980208811401368f, -0.0990297440797205f,
        -0.0528968517574562f, 1.15190312990417f,    -0.0989611768448433f,
        -0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f};
    const float low_ev = -12.47393f, high_ev = 4.026069f; /* around 1 */
    multiply(inset, rgb);
    for (int i = 0; i < 3; i++) {
        const float ev = fminf(fmaxf(log2f(fmaxf(rgb[i], 1e-10f)), low_ev), high_ev);
        rgb[i] = agx_contrast((ev - low_ev) / (high_ev - low_ev));
    }
    multiply(outset, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = powf(fminf(fmaxf(rgb[i], 0), 1), 2.2f);
}

void ppmi_tone_agx(float *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++) {
        make_light(rgba + 4 * i);
        agx(rgba + 4 * i);
    }
}

ppmi_tone_map *ppmi_tone_of_view(const char *view)
{
    if (strcmp(view, "Khronos PBR Neutral") == 0) return ppmi_tone_neutral;
    if (strcmp(view, "AgX") == 0) return ppmi_tone_agx;
    return NULL;
}
