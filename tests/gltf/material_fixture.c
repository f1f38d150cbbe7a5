#include "material_fixture.h"

#include <math.h>

const ppm_material_desc *import_material(gltf_fixture *f, const char *generator,
                                         const char *material)
{
    gltf_reset(f);
    assert_gltf_status(
        f,
        gltf_importf(f,
                     "{'asset':{'version':'2.0','generator':'%s'},'nodes':[{'mesh':0}],"
                     "'materials':[{%s}],'textures':[{'source':0,'sampler':0}],"
                     "'samplers':[{'magFilter':9728,'wrapS':33071,'wrapT':33648}],"
                     "'images':[{'uri':'data:image/"
                     "png;base64,"
                     "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVA"
                     "AAAAElFTkSuQmCC'}],"
                     "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
                     "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
                     "'bufferViews':[{'buffer':0,'byteLength':36}],"
                     "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                     "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}",
                     generator, material),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 1);
    return &f->scene->materials[0].desc;
}

void assert_values(const float *got, size_t count, const float *expected)
{
    for (size_t i = 0; i < count; ++i) {
        if (!(fabsf(got[i] - expected[i]) < 1e-6f)) {
            fail_msg("value %zu is %g, expected %g", i, (double)got[i], (double)expected[i]);
        }
    }
}
