/* importers/gltf/gltf_material_layers.c, gltf_material_inside.c, and the textures of every slot */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "imageio/imageio.h"
#include "material_fixture.h"
#include "support/near.h"

/* ---- values ---------------------------------------------------------------------------------- */

static void layers_have_the_extensions_defaults_where_they_are_absent(void **state)
{
    const ppm_material_desc *m = import_material(*state, "x", "");
    assert_values(&m->clearcoat, 1, (const float[]){0});
    assert_values(&m->clearcoat_roughness, 1, (const float[]){0});
    assert_values(&m->clearcoat_normal_scale, 1, (const float[]){1});
    assert_values(m->sheen_color, 3, (const float[]){0, 0, 0});
    assert_values(&m->iridescence, 1, (const float[]){0});
    assert_values(&m->iridescence_ior, 1, (const float[]){1.3f});
    assert_values(&m->iridescence_thickness_min_nm, 1, (const float[]){100});
    assert_values(&m->iridescence_thickness_max_nm, 1, (const float[]){400});
    assert_values(&m->anisotropy, 1, (const float[]){0});
    assert_values(&m->diffuse_transmission, 1, (const float[]){0});
    assert_values(m->diffuse_transmission_color, 3, (const float[]){1, 1, 1});
    assert_values(m->multiscatter_color, 3, (const float[]){0, 0, 0});
    assert_values(&m->retroreflection, 1, (const float[]){0});
    assert_values(&m->diffuse_roughness, 1, (const float[]){0});
    assert_values(&m->coat_ior, 1, (const float[]){1.5f});
    assert_values(m->coat_color, 3, (const float[]){1, 1, 1});
    assert_values(&m->coat_darkening, 1, (const float[]){0});
    assert_values(&m->coat_anisotropy, 1, (const float[]){0});
    assert_values(&m->fuzz, 1, (const float[]){0});
    assert_int_equal(m->roughness_is_glossiness, 0);
    assert_int_equal(m->specular_is_edge_color, 0);
    assert_int_equal(m->emission_is_above_coat, 0);
}

static void clearcoat_and_sheen_are_read(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':0.5,"
        "'clearcoatRoughnessFactor':0.25,'clearcoatNormalTexture':{'index':0,'scale':-2}},"
        "'KHR_materials_sheen':{'sheenColorFactor':[0.1,0.2,0.3],'sheenRoughnessFactor':0.75}}");
    assert_values(&m->clearcoat, 1, (const float[]){0.5f});
    assert_values(&m->clearcoat_roughness, 1, (const float[]){0.25f});
    assert_values(&m->clearcoat_normal_scale, 1, (const float[]){-2});
    assert_values(m->sheen_color, 3, (const float[]){0.1f, 0.2f, 0.3f});
    assert_values(&m->sheen_roughness, 1, (const float[]){0.75f});
}

static void iridescence_and_anisotropy_are_read(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'extensions':{'KHR_materials_iridescence':{'iridescenceFactor':0.5,'iridescenceIor':1.8,"
        "'iridescenceThicknessMinimum':500,'iridescenceThicknessMaximum':200},"
        "'KHR_materials_anisotropy':{'anisotropyStrength':0.625,'anisotropyRotation':1.5}}");
    assert_values(&m->iridescence, 1, (const float[]){0.5f});
    assert_values(&m->iridescence_ior, 1, (const float[]){1.8f});
    assert_values(&m->iridescence_thickness_min_nm, 1, (const float[]){500});
    assert_values(&m->iridescence_thickness_max_nm, 1, (const float[]){200});
    assert_values(&m->anisotropy, 1, (const float[]){0.625f});
    assert_values(&m->anisotropy_rotation_rad, 1, (const float[]){1.5f});
}

static void retroreflection_is_read_under_both_its_names(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x", "'extensions':{'KHR_materials_retroreflection':{'retroreflectionFactor':0.5}}");
    assert_values(&m->retroreflection, 1, (const float[]){0.5f});
    m = import_material(
        f, "x", "'extensions':{'EXT_materials_retroreflection':{'retroreflectionFactor':0.25}}");
    assert_values(&m->retroreflection, 1, (const float[]){0.25f});
}

static void a_coat_goes_before_a_clearcoat(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x",
        "'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':0.5},"
        "'KHR_materials_coat':{'coatFactor':0.75,'coatRoughnessFactor':0.25,'coatIor':1.75,"
        "'coatColorFactor':[0.1,0.2,0.3],'coatDarkeningFactor':0.5,'coatAnisotropyStrength':0.625,"
        "'coatAnisotropyRotation':1.5,'coatNormalTexture':{'index':0,'scale':2}}}");
    assert_values(&m->clearcoat, 1, (const float[]){0.75f});
    assert_values(&m->clearcoat_roughness, 1, (const float[]){0.25f});
    assert_values(&m->clearcoat_normal_scale, 1, (const float[]){2});
    assert_values(&m->coat_ior, 1, (const float[]){1.75f});
    assert_values(m->coat_color, 3, (const float[]){0.1f, 0.2f, 0.3f});
    assert_values(&m->coat_darkening, 1, (const float[]){0.5f});
    assert_values(&m->coat_anisotropy, 1, (const float[]){0.625f});
    assert_values(&m->coat_anisotropy_rotation_rad, 1, (const float[]){1.5f});
    assert_int_equal(m->emission_is_above_coat, 1);
    m = import_material(f, "x", "'extensions':{'KHR_materials_coat':{'coatFactor':1}}");
    assert_values(&m->coat_darkening, 1, (const float[]){1});
    assert_values(&m->coat_ior, 1, (const float[]){1.5f});
    m = import_material(f, "x",
                        "'extensions':{'KHR_materials_coat':{'coatFactor':1,'coatIor':0.5}}");
    assert_values(&m->coat_ior, 1, (const float[]){1});
    assert_gltf_logged(f, 'W', "KHR_materials_coat.coatIor is less than 1");
}

static void fuzz_goes_before_sheen(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        "'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1]},"
                        "'KHR_materials_fuzz':{'fuzzFactor':0.5,'fuzzColorFactor':[0,0,0.25]}}");
    assert_values(&m->fuzz, 1, (const float[]){0.5f});
    assert_values(m->sheen_color, 3, (const float[]){0, 0, 0.25f});
    assert_values(&m->sheen_roughness, 1, (const float[]){0.5f});
    m = import_material(f, "x",
                        "'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1]},"
                        "'KHR_materials_fuzz':{'fuzzColorFactor':[1,1,1]}}");
    assert_values(&m->fuzz, 1, (const float[]){0});
    assert_values(m->sheen_color, 3, (const float[]){0, 0, 0});
}

static void edge_colours_are_asked_for_inside_the_specular(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x",
        "'extensions':{'KHR_materials_specular':{'specularColorFactor':[1,0.5,0.25],'extensions':{"
        "'EXT_materials_specular_edge_color':{'specularEdgeColorEnabled':true}}}}");
    assert_int_equal(m->specular_is_edge_color, 1);
    assert_values(m->specular_color, 3, (const float[]){1, 0.5f, 0.25f});
    m = import_material(f, "x",
                        "'extensions':{'KHR_materials_specular':{'extensions':{"
                        "'EXT_materials_specular_edge_color':{}}}}");
    assert_int_equal(m->specular_is_edge_color, 0);
}

#define SCATTER(color, more)                                                                       \
    "'extensions':{'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':0.5,"         \
    "'diffuseTransmissionColorFactor':[0.1,0.2,0.3]},'KHR_materials_volume':{"                     \
    "'thicknessFactor':1,'attenuationDistance':2,'attenuationColor':[0.5,0.6,0.7]},"               \
    "'KHR_materials_volume_scatter':{'" color "':[0.4,0.5,0.6],'scatterAnisotropy':-0.25" more     \
    "}}"

static void scattering_is_read_under_both_names_of_its_colour(void **state)
{
    static const char *const cases[] = {SCATTER("multiscatterColor", ""),
                                        SCATTER("multiscatterColorFactor", "")};
    gltf_fixture *f = *state;
    for (size_t i = 0; i < 2; ++i) {
        const ppm_material_desc *m = import_material(f, "x", cases[i]);
        assert_values(&m->diffuse_transmission, 1, (const float[]){0.5f});
        assert_values(m->diffuse_transmission_color, 3, (const float[]){0.1f, 0.2f, 0.3f});
        assert_values(m->multiscatter_color, 3, (const float[]){0.4f, 0.5f, 0.6f});
        assert_values(&m->scatter_anisotropy_g, 1, (const float[]){-0.25f});
        assert_values(&m->attenuation_distance_m, 1, (const float[]){2});
        assert_values(m->attenuation_color, 3, (const float[]){0.5f, 0.6f, 0.7f});
        assert_values(&m->transmission, 1, (const float[]){0});
        assert_int_equal(m->transmission_kind, PPM_TRANSMISSION_SOLID);
    }
}

/* sRGB 188 is 0.5029. */
static void a_texture_of_the_medium_gives_its_mean_colour(void **state)
{
    static const float pixels[6] = {1.0f, 0.0f, 0.0f, 0.0f, 188.0f / 255.0f, 1.0f};
    gltf_fixture *f = *state;
    const ppmi_image_file file = {
        .width = 2, .height = 1, .channels = 3, .pixels = pixels, .store = PPMI_STORE_U8};
    assert_int_equal(ppmi_imageio_write_file(f->context, gltf_path(f, "sub/two.png"), &file),
                     PPM_STATUS_OK);
    assert_gltf_status(
        f,
        gltf_import(
            f,
            "{" GLTF_HEAD "'nodes':[{'mesh':0}],'materials':[{" SCATTER(
                "multiscatterColorFactor",
                ",'multiscatterColorTexture':{'index':0}") "}],'textures':[{'source':0}],"
                                                           "'images':[{'uri':'two.png'}],"
                                                           "'meshes':[{'primitives':[{'attributes':"
                                                           "{'POSITION':0},'material':0}]}],"
                                                           "'accessors':[{'componentType':5126,'"
                                                           "count':3,'type':'VEC3','sparse':{"
                                                           "'count':1,'indices':{'bufferView':0,'"
                                                           "componentType':5121},"
                                                           "'values':{'bufferView':1}}}],'"
                                                           "bufferViews':[{'buffer':0,'byteLength':"
                                                           "1},"
                                                           "{'buffer':0,'byteOffset':4,'byteLength'"
                                                           ":12}],"
                                                           "'buffers':[{'byteLength':16,'uri':'"
                                                           "data:;base64,AQAAAAAAgD8AAAAAAAAAAA=='"
                                                           "}]}"),
        PPM_STATUS_OK);
    assert_values(f->scene->materials[0].desc.multiscatter_color, 1, (const float[]){0.4f * 0.5f});
    assert_true(fabsf(f->scene->materials[0].desc.multiscatter_color[1] - 0.5f * 0.5f * 0.5029f) <
                1e-4f);
    assert_values(f->scene->materials[0].desc.multiscatter_color + 2, 1,
                  (const float[]){0.6f * 0.5f});
    assert_gltf_logged(f, 'I', "approximated: KHR_materials_volume_scatter: the medium inside");
}

/* Blender leaves out the thickness of its glass; what seeps through a leaf has none to leave out.
 */
static void a_sheet_that_light_seeps_through_is_thin(void **state)
{
    static const char material[] = "'extensions':{'KHR_materials_diffuse_transmission':{"
                                   "'diffuseTransmissionFactor':1}}";
    gltf_fixture *f = *state;
    assert_int_equal(import_material(f, "x", material)->transmission_kind, PPM_TRANSMISSION_THIN);
    assert_int_equal(
        import_material(f, "Khronos glTF Blender I/O v4.0.44", material)->transmission_kind,
        PPM_TRANSMISSION_THIN);
    f->options.transmission = PPM_TRANSMISSION_POLICY_SOLID;
    assert_int_equal(import_material(f, "x", material)->transmission_kind, PPM_TRANSMISSION_SOLID);
}

/* ---- KHR_materials_scatter ------------------------------------------------------------------- */

#define SHEET(transmission, strength, more)                                                        \
    "'pbrMetallicRoughness':{'metallicFactor':0,'baseColorFactor':[0.2,0.4,0.6,1]},'extensions':{" \
    "'KHR_materials_transmission':{'transmissionFactor':" transmission                             \
    "},'KHR_materials_scatter':{'scatterStrengthFactor':" strength more "}}"

static void scatter_without_strength_changes_nothing(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':0.5},"
                        "'KHR_materials_scatter':{'multiscatterColorFactor':[0.4,0.5,0.6]}}");
    assert_values(&m->transmission, 1, (const float[]){0.5f});
    assert_values(&m->diffuse_transmission, 1, (const float[]){0});
    m = import_material(f, "x",
                        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':0.5},"
                        "'KHR_materials_volume':{'thicknessFactor':1},"
                        "'KHR_materials_scatter':{'multiscatterColorFactor':[0.4,0.5,0.6]}}");
    assert_values(m->multiscatter_color, 3, (const float[]){0, 0, 0});
}

/* s^2 of Kulla and Conty 2017 */
static double single_albedo_gap(double c)
{
    const double s = 4.09712 + 4.20863 * c - sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c);
    return s * s;
}

static void scatter_inside_solids_is_that_of_volumes(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
        "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2},"
        "'KHR_materials_scatter':{'scatterStrengthFactor':0.5,'scatterAnisotropy':0.25,"
        "'multiscatterColorFactor':[0.4,0.6,0.8]}}");
    assert_int_equal(m->transmission_kind, PPM_TRANSMISSION_SOLID);
    const double colors[3] = {0.2, 0.3, 0.4}, g = 0.25;
    for (int i = 0; i < 3; ++i) {
        const double got = single_albedo_gap(m->multiscatter_color[i]);
        const double gap = single_albedo_gap(colors[i]);
        assert_near(1.0 - got, (1.0 - gap) / (1.0 - g * gap), 1e-5);
    }
    assert_values(&m->scatter_anisotropy_g, 1, (const float[]){0.25f});
    assert_values(&m->attenuation_distance_m, 1, (const float[]){2});
    assert_values(&m->transmission, 1, (const float[]){1});
}

/* The lobes of the scene's material against the draft's, each by its weight and colour. */
static void scatter_on_sheets_has_the_lobes_of_the_draft(void **state)
{
    static const struct {
        const char *material;
        float transmission, strength, g;
        bool is_exact;
    } cases[] = {
        {SHEET("1", "1", ""), 1, 1, 0, true},
        {SHEET("0.5", "1", ",'scatterAnisotropy':0.5"), 0.5f, 1, 0.5f, true},
        {SHEET("0.75", "0.5", ",'scatterAnisotropy':1"), 0.75f, 0.5f, 1, true},
        {SHEET("1", "1", ",'scatterAnisotropy':-1"), 1, 1, -1, true},
        {SHEET("0.5", "0.5", ",'scatterAnisotropy':-0.5"), 0.5f, 0.5f, -0.5f, false},
    };
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const ppm_material_desc *m = import_material(f, "x", cases[i].material);
        const float t = cases[i].transmission, s = cases[i].strength, g = cases[i].g;
        const float base = 0.2f, scattered = 1.0f; /* red */
        assert_values(&m->transmission, 1, (const float[]){t * (1 - s)});
        const float diffuse = 1 - m->transmission;
        const float through = diffuse * m->diffuse_transmission * m->diffuse_transmission_color[0];
        assert_values(&through, 1, (const float[]){t * s * (1 + g) / 2 * scattered});
        const float back = diffuse * (1 - m->diffuse_transmission) * m->base_color[0];
        assert_values(&back, 1, (const float[]){(1 - t) * base + t * s * (1 - g) / 2 * scattered});
        if (m->transmission > 0 && cases[i].is_exact) {
            assert_values(m->base_color, 1, &base); /* which tints the glass */
        }
        assert_int_equal(gltf_logged(f, 'I', "approximated: KHR_materials_scatter"),
                         !cases[i].is_exact);
    }
}

static void scatter_textures_reach_their_slots(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x",
        SHEET("1", "1",
              ",'scatterAnisotropy':0.5,'multiscatterColorTexture':{'index':0,'texCoord':1}"));
    assert_true(m->diffuse_transmission_color_texture.image != 0);
    assert_int_equal(m->base_color_texture.image, m->diffuse_transmission_color_texture.image);
    assert_int_equal(m->base_color_texture.uv_set, 1);
    assert_true(f->scene->images[m->base_color_texture.image - 1].is_srgb);
}

/* ---- bad values ------------------------------------------------------------------------------ */

#define AT(member) offsetof(ppm_material_desc, member)

static void values_out_of_range_are_brought_into_it_with_a_warning(void **state)
{
    static const struct {
        const char *extension, *members, *warning;
        size_t at;
        float expected;
    } cases[] = {
        {"clearcoat", "'clearcoatFactor':2", "clearcoatFactor is brought into 0 .. 1",
         AT(clearcoat), 1},
        {"clearcoat", "'clearcoatRoughnessFactor':-1", "clearcoatRoughnessFactor is brought",
         AT(clearcoat_roughness), 0},
        {"clearcoat", "'clearcoatFactor':'x'",
         "materials[0].extensions.KHR_materials_clearcoat.clearcoatFactor: expected a number",
         AT(clearcoat), 0},
        {"sheen", "'sheenColorFactor':[2,0,0]", "sheenColorFactor is brought into 0 .. 1",
         AT(sheen_color), 1},
        {"sheen", "'sheenColorFactor':[1,1]", "sheenColorFactor: wrong number of items",
         AT(sheen_color), 0},
        {"sheen", "'sheenRoughnessFactor':7", "sheenRoughnessFactor is brought",
         AT(sheen_roughness), 1},
        {"iridescence", "'iridescenceFactor':-2", "iridescenceFactor is brought", AT(iridescence),
         0},
        {"iridescence", "'iridescenceIor':0.5", "iridescenceIor is brought into 1 .. 1000",
         AT(iridescence_ior), 1},
        {"iridescence", "'iridescenceThicknessMinimum':-5", "iridescenceThicknessMinimum is",
         AT(iridescence_thickness_min_nm), 0},
        {"iridescence", "'iridescenceThicknessMaximum':1e30", "iridescenceThicknessMaximum is",
         AT(iridescence_thickness_max_nm), 1e6f},
        {"anisotropy", "'anisotropyStrength':3", "anisotropyStrength is brought", AT(anisotropy),
         1},
        {"anisotropy", "'anisotropyRotation':1e300", "anisotropyRotation: the number is too large",
         AT(anisotropy_rotation_rad), 0},
        {"retroreflection", "'retroreflectionFactor':3", "retroreflectionFactor is brought",
         AT(retroreflection), 1},
        {"diffuse_roughness", "'diffuseRoughnessFactor':3", "diffuseRoughnessFactor is brought",
         AT(diffuse_roughness), 1},
        {"coat", "'coatFactor':3", "coatFactor is brought", AT(clearcoat), 1},
        {"coat", "'coatColorFactor':[3,0,0]", "coatColorFactor is brought", AT(coat_color), 1},
        {"coat", "'coatDarkeningFactor':-1", "coatDarkeningFactor is brought", AT(coat_darkening),
         0},
        {"coat", "'coatIor':1e9", "coatIor is brought", AT(coat_ior), 1000},
        {"fuzz", "'fuzzFactor':3", "fuzzFactor is brought", AT(fuzz), 1},
        {"diffuse_transmission", "'diffuseTransmissionFactor':3", "diffuseTransmissionFactor is",
         AT(diffuse_transmission), 1},
        {"diffuse_transmission",
         "'diffuseTransmissionFactor':1,'diffuseTransmissionColorFactor':[-1,0,0]",
         "diffuseTransmissionColorFactor is", AT(diffuse_transmission_color), 0},
    };
    gltf_fixture *f = *state;
    char material[300];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        snprintf(material, sizeof material, "'extensions':{'KHR_materials_%s':{%s}}",
                 cases[i].extension, cases[i].members);
        const ppm_material_desc *m = import_material(f, "x", material);
        float value;
        memcpy(&value, (const char *)m + cases[i].at, sizeof value);
        assert_values(&value, 1, &cases[i].expected);
        assert_gltf_logged(f, 'W', cases[i].warning);
    }
}

static void the_anisotropy_of_scattering_stays_short_of_a_pulse(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x",
        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
        "'KHR_materials_volume':{'thicknessFactor':1},"
        "'KHR_materials_volume_scatter':{'multiscatterColor':[2,1,1],'scatterAnisotropy':1}}");
    assert_true(m->scatter_anisotropy_g > 0.99f && m->scatter_anisotropy_g < 1.0f);
    assert_values(m->multiscatter_color, 3, (const float[]){1, 1, 1});
    assert_gltf_logged(f, 'W', "scatterAnisotropy is brought into");
    assert_gltf_logged(f, 'W', "multiscatterColorFactor is brought into");
}

/* ---- textures -------------------------------------------------------------------------------- */

/* Every slot: what stands before and behind the texture info, and where it ends up. */
static const struct {
    const char *before, *after;
    size_t at;
} slots[] = {
    {"'pbrMetallicRoughness':{'baseColorTexture':", "}", AT(base_color_texture)},
    {"'pbrMetallicRoughness':{'metallicRoughnessTexture':", "}", AT(metallic_roughness_texture)},
    {"'normalTexture':", "", AT(normal_texture)},
    {"'emissiveFactor':[1,1,1],'emissiveTexture':", "", AT(emission_texture)},
#define SLOT(extension, factor, name, member)                                                      \
    {                                                                                              \
        "'extensions':{'KHR_materials_" extension "':{" factor "'" name "':", "}}", AT(member)     \
    }
    SLOT("anisotropy", "'anisotropyStrength':1,", "anisotropyTexture", anisotropy_texture),
    SLOT("clearcoat", "'clearcoatFactor':1,", "clearcoatTexture", clearcoat_texture),
    SLOT("clearcoat", "'clearcoatFactor':1,", "clearcoatRoughnessTexture",
         clearcoat_roughness_texture),
    SLOT("clearcoat", "'clearcoatFactor':1,", "clearcoatNormalTexture", clearcoat_normal_texture),
    SLOT("diffuse_transmission", "'diffuseTransmissionFactor':1,", "diffuseTransmissionTexture",
         diffuse_transmission_texture),
    SLOT("diffuse_transmission", "'diffuseTransmissionFactor':1,",
         "diffuseTransmissionColorTexture", diffuse_transmission_color_texture),
    SLOT("iridescence", "'iridescenceFactor':1,", "iridescenceTexture", iridescence_texture),
    SLOT("iridescence", "'iridescenceFactor':1,", "iridescenceThicknessTexture",
         iridescence_thickness_texture),
    SLOT("pbrSpecularGlossiness", "", "diffuseTexture", base_color_texture),
    SLOT("pbrSpecularGlossiness", "", "specularGlossinessTexture", specular_color_texture),
    SLOT("pbrSpecularGlossiness", "", "specularGlossinessTexture", metallic_roughness_texture),
    SLOT("diffuse_roughness", "'diffuseRoughnessFactor':1,", "diffuseRoughnessTexture",
         diffuse_roughness_texture),
    SLOT("coat", "'coatFactor':1,", "coatTexture", clearcoat_texture),
    SLOT("coat", "'coatFactor':1,", "coatRoughnessTexture", clearcoat_roughness_texture),
    SLOT("coat", "'coatFactor':1,", "coatNormalTexture", clearcoat_normal_texture),
    SLOT("coat", "'coatFactor':1,", "coatColorTexture", coat_color_texture),
    SLOT("coat", "'coatFactor':1,", "coatAnisotropyTexture", coat_anisotropy_texture),
    SLOT("fuzz", "'fuzzFactor':1,", "fuzzTexture", fuzz_texture),
    SLOT("fuzz", "'fuzzFactor':1,", "fuzzColorTexture", sheen_color_texture),
    SLOT("fuzz", "'fuzzFactor':1,", "fuzzRoughnessTexture", sheen_roughness_texture),
    SLOT("retroreflection", "'retroreflectionFactor':1,", "retroreflectionTexture",
         retroreflection_texture),
    {"'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
     "'KHR_materials_scatter':{'scatterStrengthFactor':1,'multiscatterColorTexture':",
     "}}", offsetof(ppm_material_desc, diffuse_transmission_color_texture)},
    SLOT("sheen", "'sheenColorFactor':[1,1,1],", "sheenColorTexture", sheen_color_texture),
    SLOT("sheen", "'sheenColorFactor':[1,1,1],", "sheenRoughnessTexture", sheen_roughness_texture),
    SLOT("specular", "", "specularTexture", specular_texture),
    SLOT("specular", "", "specularColorTexture", specular_color_texture),
    SLOT("transmission", "'transmissionFactor':1,", "transmissionTexture", transmission_texture),
};

static ppm_texture import_slot(gltf_fixture *f, size_t slot, const char *info)
{
    char material[400];
    ppm_texture texture;
    snprintf(material, sizeof material, "%s%s%s", slots[slot].before, info, slots[slot].after);
    const ppm_material_desc *m = import_material(f, "x", material);
    memcpy(&texture, (const char *)m + slots[slot].at, sizeof texture);
    return texture;
}

static void every_slot_takes_a_texture_transform_with_its_own_coordinates(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; ++i) {
        const ppm_texture t = import_slot(
            f, i,
            "{'index':0,'texCoord':1,'extensions':{'KHR_texture_transform':{'offset':[0.25,0.5],"
            "'rotation':1.5707963267948966,'scale':[2,4],'texCoord':3}}}");
        if (t.image == 0) fail_msg("%s: no texture", slots[i].before);
        assert_int_equal(t.uv_set, 3);
        assert_int_not_equal(t.has_transform, 0);
        assert_values(t.uv_transform, 6, (const float[]){0, 4, 0.25f, -2, 0, 0.5f});
        assert_int_equal(t.wrap_u, PPM_WRAP_CLAMP);
    }
}

static void every_slot_keeps_its_coordinates_without_a_transform(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; ++i) {
        const ppm_texture t = import_slot(f, i, "{'index':0,'texCoord':2}");
        assert_int_not_equal(t.image, 0);
        assert_int_equal(t.uv_set, 2);
        assert_int_equal(t.has_transform, 0);
    }
}

static void every_slot_goes_on_without_a_texture_that_is_not_there(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof slots / sizeof slots[0]; ++i) {
        const ppm_texture t = import_slot(f, i, "{'index':7}");
        assert_int_equal(t.image, 0);
        assert_gltf_logged(f, 'W', "textures[7] does not exist");
    }
}

/* An image of colours must be decoded, one of numbers must not. */
static void slots_of_colours_and_of_numbers_have_images_of_their_own(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        "'extensions':{'KHR_materials_sheen':{'sheenColorTexture':{'index':0},"
                        "'sheenRoughnessTexture':{'index':0}},"
                        "'KHR_materials_clearcoat':{'clearcoatTexture':{'index':0}}}");
    assert_int_not_equal(m->sheen_color_texture.image, m->clearcoat_texture.image);
    assert_int_equal(m->sheen_color_texture.image, m->sheen_roughness_texture.image);
    assert_int_equal(f->scene->image_count, 2);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(layers_have_the_extensions_defaults_where_they_are_absent),
        TEST(clearcoat_and_sheen_are_read),
        TEST(iridescence_and_anisotropy_are_read),
        TEST(retroreflection_is_read_under_both_its_names),
        TEST(a_coat_goes_before_a_clearcoat),
        TEST(fuzz_goes_before_sheen),
        TEST(edge_colours_are_asked_for_inside_the_specular),
        TEST(scattering_is_read_under_both_names_of_its_colour),
        TEST(a_texture_of_the_medium_gives_its_mean_colour),
        TEST(scatter_without_strength_changes_nothing),
        TEST(scatter_inside_solids_is_that_of_volumes),
        TEST(scatter_on_sheets_has_the_lobes_of_the_draft),
        TEST(scatter_textures_reach_their_slots),
        TEST(a_sheet_that_light_seeps_through_is_thin),
        TEST(values_out_of_range_are_brought_into_it_with_a_warning),
        TEST(the_anisotropy_of_scattering_stays_short_of_a_pulse),
        TEST(every_slot_takes_a_texture_transform_with_its_own_coordinates),
        TEST(every_slot_keeps_its_coordinates_without_a_transform),
        TEST(every_slot_goes_on_without_a_texture_that_is_not_there),
        TEST(slots_of_colours_and_of_numbers_have_images_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
