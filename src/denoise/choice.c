/* SURE is unbiased but of a single pixel very noisy: it is averaged over a neighbourhood, the best
 * candidate is taken, and the choice is softened, as in Rousselle et al. 2013, section 5. They
 * average it by a filter that follows edges; a box is more careful: what fails at an edge is not
 * taken beside it either. */
#include "denoise/choice.h"

enum { RISK_RADIUS = 3, SOFT_RADIUS = 1 };

/* What a candidate's risk has to stay below: that of no filter is 1. Of light that is blurred
 * already the risk knows the noise alone; a filter adds to the other error, so it has to gain more.
 * Pool, 32 x 24, 8 passes of sppm, its caustics alone: the error becomes 1.042 times what it was
 * with 0.95, 0.994 with 0.8. */
static const float most_risk = 0.95f, most_risk_if_blurred = 0.8f;

static float mean_of(const float *values, size_t stride, int64_t count, int64_t at, int radius)
{
    const int64_t first = at - radius < 0 ? 0 : at - radius;
    const int64_t last = at + radius >= count ? count - 1 : at + radius;
    float sum = 0.0f;
    for (int64_t i = first; i <= last; i++)
        sum += values[(size_t)i * stride];
    return sum / (float)(last - first + 1);
}

void ppmi_denoise_blur(uint32_t width, uint32_t height, int radius, float *values, float *scratch)
{
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++)
            scratch[(size_t)y * width + x] =
                mean_of(values + (size_t)y * width, 1, width, x, radius);
    }
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++)
            values[(size_t)y * width + x] = mean_of(scratch + x, width, height, y, radius);
    }
}

/* Turns risks into shares: 1 for the candidate of the least, if that is below least. */
static void take_best(const ppmi_nl_output *candidates, size_t pixel, float least)
{
    int best = -1;
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++) {
        const float risk = candidates[i].risk[pixel];
        if (risk < least) {
            least = risk;
            best = i;
        }
    }
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++)
        candidates[i].risk[pixel] = i == best ? 1.0f : 0.0f;
}

static void mix(const ppmi_nl_output *candidates, size_t pixel, float *light)
{
    for (size_t c = 3 * pixel; c < 3 * pixel + 3; c++) {
        const float before = light[c];
        for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++)
            light[c] += candidates[i].risk[pixel] * (candidates[i].light[c] - before);
        if (light[c] < 0.0f) light[c] = 0.0f; /* rounding */
    }
}

void ppmi_denoise_choose(uint32_t width, uint32_t height,
                         const ppmi_nl_output candidates[PPMI_DENOISE_CANDIDATES], bool is_blurred,
                         float *scratch, float *light)
{
    const size_t pixels = (size_t)width * height;
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++)
        ppmi_denoise_blur(width, height, RISK_RADIUS, candidates[i].risk, scratch);
    const float most = is_blurred ? most_risk_if_blurred : most_risk;
    for (size_t i = 0; i < pixels; i++)
        take_best(candidates, i, most);
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++)
        ppmi_denoise_blur(width, height, SOFT_RADIUS, candidates[i].risk, scratch);
    for (size_t i = 0; i < pixels; i++)
        mix(candidates, i, light);
}
