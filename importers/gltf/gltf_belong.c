#include "gltf/gltf_belong.h"

#include <string.h>

#include "gltf/gltf_pose.h"

enum { NONE = -1 };

/* Parents come before their children. */
void ppmi_gltf_belong_find(ppmi_gltf_reader *reader)
{
    ppmi_gltf_pose *pose = reader->pose;
    const ppmi_gltf_node *nodes = reader->document->nodes;
    for (size_t i = 0; i < pose->order_count; ++i) {
        const int32_t node = pose->order[i], parent = pose->parents[node];
        pose->assets[node] = parent < 0 ? NONE : pose->assets[parent];
        pose->groups[node] = parent < 0 ? NONE : pose->groups[parent];
        if (parent >= 0 && pose->assets[node] == NONE && nodes[parent].name[0]) {
            pose->assets[node] = parent;
        }
        if (nodes[node].lamp.light_group[0]) pose->groups[node] = node;
    }
}

static const char *write_name(const char *name, char *buffer, size_t size)
{
    return name[0] ? ppmi_gltf_printable(name, strlen(name), buffer, size) : NULL;
}

const char *ppmi_gltf_asset_name(const ppmi_gltf_reader *reader, int32_t node, char *buffer,
                                 size_t size)
{
    const int32_t at = reader->pose->assets[node];
    return at == NONE ? NULL : write_name(reader->document->nodes[at].name, buffer, size);
}

const char *ppmi_gltf_light_group(const ppmi_gltf_reader *reader, int32_t node, const char *own,
                                  char *buffer, size_t size)
{
    const int32_t at = reader->pose->groups[node];
    if (own[0] || at == NONE) return write_name(own, buffer, size);
    return write_name(reader->document->nodes[at].lamp.light_group, buffer, size);
}
