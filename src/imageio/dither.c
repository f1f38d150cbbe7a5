/* Triangular noise of one step to either side makes mean and variance of the rounding error
 * independent of the value (Lipshitz, Wannamaker, Vanderkooy 1992, "Quantization and Dither").
 * Within half a step of the ends, where a part of it would be cut off, noise of half the width
 * keeps the mean: black and white stay what they are. */
#include "imageio/dither.h"

/* A permutation of 32 bits with good avalanche: Wellons 2018, "Prospecting for Hash Functions". */
static uint32_t mix(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

float ppmi_dither(uint32_t x, uint32_t y, float value, float top)
{
    const uint32_t bits = mix(x + mix(y + 0x9e3779b9u));
    const float u = ((float)(bits & 0xffff) + 0.5f) / 65536.0f - 0.5f;
    const float v = ((float)(bits >> 16) + 0.5f) / 65536.0f - 0.5f;
    const int is_near_end = value < 0.5f || value > top - 0.5f;
    return is_near_end ? u : u + v;
}
