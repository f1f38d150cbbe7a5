/* The formats of KTX files: VkFormat and what it stores (Vulkan 1.3 specification, 49.1). */
#include <stddef.h>

#include "gltf/ktx2.h"
#include "gltf/ktx2_astc.h"

#define LETTERS(a, b, c, d)                                                                        \
    ((uint32_t)(a) | (uint32_t)(b) << 8 | (uint32_t)(c) << 16 | (uint32_t)(d) << 24)
#define DXT1 LETTERS('D', 'X', 'T', '1')
#define DXT3 LETTERS('D', 'X', 'T', '3')
#define DXT5 LETTERS('D', 'X', 'T', '5')
enum { DXGI_BC6H_UF16 = 95, DXGI_BC6H_SF16 = 96, DXGI_BC7 = 98 };

/* KHR_DF_MODEL_ of the Khronos Data Format specification. */
enum { MODEL_ETC1S = 163, MODEL_UASTC = 166, MODEL_UASTC_HDR = 167 };

/* BC4 and BC5 are not here: one or two channels that OpenImageIO takes for grey and no alpha. */
static const ppmi_ktx2_format formats[] = {
    {9, PPMI_KTX2_U8, 1, 1, false, false, 0, {0, 0}},
    {15, PPMI_KTX2_U8, 1, 1, true, false, 0, {0, 0}},
    {16, PPMI_KTX2_U8, 2, 2, false, false, 0, {0, 0}},
    {22, PPMI_KTX2_U8, 2, 2, true, false, 0, {0, 0}},
    {23, PPMI_KTX2_U8, 3, 3, false, false, 0, {0, 0}},
    {29, PPMI_KTX2_U8, 3, 3, true, false, 0, {0, 0}},
    {30, PPMI_KTX2_U8, 3, 3, false, true, 0, {0, 0}},
    {36, PPMI_KTX2_U8, 3, 3, true, true, 0, {0, 0}},
    {37, PPMI_KTX2_U8, 4, 4, false, false, 0, {0, 0}},
    {43, PPMI_KTX2_U8, 4, 4, true, false, 0, {0, 0}},
    {44, PPMI_KTX2_U8, 4, 4, false, true, 0, {0, 0}},
    {50, PPMI_KTX2_U8, 4, 4, true, true, 0, {0, 0}},
    {70, PPMI_KTX2_U16, 1, 2, false, false, 0, {0, 0}},
    {76, PPMI_KTX2_F16, 1, 2, false, false, 0, {0, 0}},
    {77, PPMI_KTX2_U16, 2, 4, false, false, 0, {0, 0}},
    {83, PPMI_KTX2_F16, 2, 4, false, false, 0, {0, 0}},
    {84, PPMI_KTX2_U16, 3, 6, false, false, 0, {0, 0}},
    {90, PPMI_KTX2_F16, 3, 6, false, false, 0, {0, 0}},
    {91, PPMI_KTX2_U16, 4, 8, false, false, 0, {0, 0}},
    {97, PPMI_KTX2_F16, 4, 8, false, false, 0, {0, 0}},
    {100, PPMI_KTX2_F32, 1, 4, false, false, 0, {0, 0}},
    {103, PPMI_KTX2_F32, 2, 8, false, false, 0, {0, 0}},
    {106, PPMI_KTX2_F32, 3, 12, false, false, 0, {0, 0}},
    {109, PPMI_KTX2_F32, 4, 16, false, false, 0, {0, 0}},
    {122, PPMI_KTX2_B10G11R11, 3, 4, false, false, 0, {0, 0}},
    {123, PPMI_KTX2_E5B9G9R9, 3, 4, false, false, 0, {0, 0}},
    {131, PPMI_KTX2_BLOCKS, 3, 8, false, false, DXT1, {0, 0}},
    {132, PPMI_KTX2_BLOCKS, 3, 8, true, false, DXT1, {0, 0}},
    {133, PPMI_KTX2_BLOCKS, 4, 8, false, false, DXT1, {0, 0}},
    {134, PPMI_KTX2_BLOCKS, 4, 8, true, false, DXT1, {0, 0}},
    {135, PPMI_KTX2_BLOCKS, 4, 16, false, false, DXT3, {0, 0}},
    {136, PPMI_KTX2_BLOCKS, 4, 16, true, false, DXT3, {0, 0}},
    {137, PPMI_KTX2_BLOCKS, 4, 16, false, false, DXT5, {0, 0}},
    {138, PPMI_KTX2_BLOCKS, 4, 16, true, false, DXT5, {0, 0}},
    {143, PPMI_KTX2_BLOCKS, 3, 16, false, false, DXGI_BC6H_UF16, {0, 0}},
    {144, PPMI_KTX2_BLOCKS, 3, 16, false, false, DXGI_BC6H_SF16, {0, 0}},
    {145, PPMI_KTX2_BLOCKS, 4, 16, false, false, DXGI_BC7, {0, 0}},
    {146, PPMI_KTX2_BLOCKS, 4, 16, true, false, DXGI_BC7, {0, 0}},
};

/* Ranges of VkFormat that people meet and that are not read. */
static const struct {
    uint32_t first, last;
    const char *name;
} unread[] = {
    {139, 140, "BC4"},
    {141, 142, "BC5"},
    {147, 152, "ETC2"},
    {153, 156, "EAC"},
    {157, 184, "ASTC"},
    {1000054000, 1000054007, "PVRTC"},
    {1000066000, 1000066013, "ASTC HDR"},
};

/* From 157 on an UNORM and an SRGB format of each size, in this order. */
static bool find_astc(uint32_t vulkan, ppmi_ktx2_format *out)
{
    static const uint8_t sizes[][2] = {{4, 4},  {5, 4},   {5, 5},   {6, 5},  {6, 6},
                                       {8, 5},  {8, 6},   {8, 8},   {10, 5}, {10, 6},
                                       {10, 8}, {10, 10}, {12, 10}, {12, 12}};
    enum { FIRST = 157, COUNT = 2 * sizeof sizes / sizeof sizes[0], BLOCK_BYTES = 16 };
    if (vulkan < FIRST || vulkan >= FIRST + COUNT || !ppmi_ktx2_has_astc()) return false;
    const uint8_t *size = sizes[(vulkan - FIRST) / 2];
    *out = (ppmi_ktx2_format){.vulkan = vulkan,
                              .kind = PPMI_KTX2_ASTC,
                              .channels = 4,
                              .bytes = BLOCK_BYTES,
                              .is_srgb = (vulkan - FIRST) % 2 == 1,
                              .block = {size[0], size[1]}};
    return true;
}

bool ppmi_ktx2_find_format(uint32_t vulkan, uint32_t color_model, ppmi_ktx2_format *out)
{
    if (vulkan == 0 && color_model == MODEL_ETC1S) {
        *out = (ppmi_ktx2_format){.kind = PPMI_KTX2_ETC1S, .channels = 4};
        return true;
    }
    if (vulkan == 0 && color_model == MODEL_UASTC) {
        *out = (ppmi_ktx2_format){
            .kind = PPMI_KTX2_UASTC, .channels = 4, .bytes = 16, .block = {4, 4}};
        return true;
    }
    if (find_astc(vulkan, out)) return true;
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; ++i) {
        if (formats[i].vulkan != vulkan) continue;
        *out = formats[i];
        return true;
    }
    return false;
}

const char *ppmi_ktx2_format_name(uint32_t vulkan, uint32_t color_model)
{
    if (vulkan == 0 && color_model == MODEL_UASTC_HDR) return "Basis Universal (UASTC HDR)";
    for (size_t i = 0; i < sizeof unread / sizeof unread[0]; ++i) {
        if (vulkan >= unread[i].first && vulkan <= unread[i].last) return unread[i].name;
    }
    return NULL;
}
