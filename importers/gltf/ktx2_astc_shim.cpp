// The only file that sees astcenc. Versions 4 and 5 differ in what only encoders use.
#include "gltf/ktx2_astc.h"

#if PPM_HAS_ASTC
#include <astcenc.h>

namespace
{
ppm_status status_of(astcenc_error error)
{
    if (error == ASTCENC_SUCCESS) return PPM_STATUS_OK;
    return error == ASTCENC_ERR_OUT_OF_MEM ? PPM_STATUS_OUT_OF_MEMORY
                                           : PPM_STATUS_INPUT_UNSUPPORTED;
}

ppm_status decode(const uint8_t *blocks, size_t byte_count, const uint8_t block[2], bool is_srgb,
                  uint32_t width, uint32_t height, uint8_t *out)
{
    const astcenc_swizzle as_stored = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};
    const astcenc_profile profile = is_srgb ? ASTCENC_PRF_LDR_SRGB : ASTCENC_PRF_LDR;
    astcenc_config config = {};
    astcenc_context *context = nullptr;
    ppm_status status = status_of(astcenc_config_init(
        profile, block[0], block[1], 1, ASTCENC_PRE_FASTEST, ASTCENC_FLG_DECOMPRESS_ONLY, &config));
    if (status == PPM_STATUS_OK) status = status_of(astcenc_context_alloc(&config, 1, &context));
    if (status != PPM_STATUS_OK) return status;
    void *slices[] = {out};
    astcenc_image image = {width, height, 1, ASTCENC_TYPE_U8, slices};
    status =
        status_of(astcenc_decompress_image(context, blocks, byte_count, &image, &as_stored, 0));
    astcenc_context_free(context);
    return status;
}
} // namespace

bool ppmi_ktx2_has_astc(void)
{
    return true;
}

ppm_status ppmi_ktx2_decode_astc(const uint8_t *blocks, size_t byte_count, const uint8_t block[2],
                                 bool is_srgb, uint32_t width, uint32_t height, uint8_t *out)
{
    try {
        return decode(blocks, byte_count, block, is_srgb, width, height, out);
    } catch (...) { // of its containers: memory
        return PPM_STATUS_OUT_OF_MEMORY;
    }
}
#else
bool ppmi_ktx2_has_astc(void)
{
    return false;
}

ppm_status ppmi_ktx2_decode_astc(const uint8_t *, size_t, const uint8_t[2], bool, uint32_t,
                                 uint32_t, uint8_t *)
{
    return PPM_STATUS_INPUT_UNSUPPORTED;
}
#endif
