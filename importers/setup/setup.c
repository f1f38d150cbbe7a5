/* A setup file: read, checked, listed, applied. Sections are checked in the order of the file, and
 * applied in the order in which they need each other. */
#include "ppm/setup.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "setup/setup_file.h"

static const char ending[] = ".ppm.json";

ppm_status ppmi_setup_out_of_memory(ppm_setup *setup)
{
    return ppmi_fail(setup->context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", setup->path);
}

bool ppmi_setup_grow(ppm_context *context, void **items, size_t count, size_t *capacity,
                     size_t element_size)
{
    if (count < *capacity) return true;
    const size_t wanted = *capacity > 0 ? 2 * *capacity : 8;
    void *grown = ppmi_alloc_zeroed(context, wanted, element_size);
    if (!grown) return false;
    if (count > 0) memcpy(grown, *items, count * element_size);
    ppmi_free(context, *items);
    *items = grown;
    *capacity = wanted;
    return true;
}

ppm_status ppmi_setup_add_entry(ppm_setup *setup, uint32_t part, const char *name,
                                const char *detail)
{
    if (!ppmi_setup_grow(setup->context, (void **)&setup->entries, setup->entry_count,
                         &setup->entry_capacity, sizeof *setup->entries)) {
        return ppmi_setup_out_of_memory(setup);
    }
    ppmi_setup_entry *entry = &setup->entries[setup->entry_count++];
    *entry = (ppmi_setup_entry){.part = part,
                                .name = ppmi_string_copy(setup->context, name),
                                .detail = ppmi_string_copy(setup->context, detail)};
    return entry->name && entry->detail ? PPM_STATUS_OK : ppmi_setup_out_of_memory(setup);
}

/* ---- sections -------------------------------------------------------------------------------- */

/* In the order in which they are applied: nodes name materials, cameras focus on nodes. */
static const struct section {
    const char *name;
    uint32_t part;
    bool is_list;
    ppm_status (*read)(const ppmi_setup_value *value);
} sections[] = {
    {"materials", PPM_SETUP_MATERIALS, true, ppmi_setup_material_section},
    {"nodes", PPM_SETUP_NODES, true, ppmi_setup_node_section},
    {"cameras", PPM_SETUP_CAMERAS, true, ppmi_setup_camera_section},
    {"lights", PPM_SETUP_LIGHTS, true, ppmi_setup_light_section},
    {"environment", PPM_SETUP_ENVIRONMENT, false, ppmi_setup_environment_section},
    {"fog", PPM_SETUP_FOG, false, ppmi_setup_fog_section},
    {"render", 0, false, ppmi_setup_render_section},
};
enum { SECTION_COUNT = sizeof sections / sizeof sections[0] };

static ppm_status read_section(const ppmi_setup_value *value, const ppmi_setup_key *key,
                               void *target)
{
    const struct section *section = &sections[key->field];
    (void)target;
    if (!section->is_list) return section->read(value);
    if (!json_is_array(value->json)) return ppmi_setup_refuse(value, "a list: [ { ... }, ... ]");
    ppm_status status = PPM_STATUS_OK;
    for (size_t i = 0; i < json_array_size(value->json) && status == PPM_STATUS_OK; i++) {
        const ppmi_setup_value element = ppmi_setup_element(value, i);
        status = section->read(&element);
    }
    return status;
}

static ppm_status check(ppm_setup *setup)
{
    const ppmi_setup_value root = {.setup = setup, .json = setup->root};
    ppmi_setup_key keys[SECTION_COUNT];
    for (size_t i = 0; i < SECTION_COUNT; i++) {
        keys[i] = (ppmi_setup_key){
            .name = sections[i].name, .kind = PPMI_SETUP_OWN, .field = i, .read = read_section};
    }
    return ppmi_setup_read_object(&root, keys, SECTION_COUNT, NULL, NULL);
}

/* ---- what is in it --------------------------------------------------------------------------- */

/* A name or a pattern; of a list the first with dots. */
static void write_name(const json_t *element, char *buffer, size_t size)
{
    const json_t *name = json_object_get(element, "match");
    const bool is_list = json_is_array(name);
    if (!name) name = json_object_get(element, "name");
    if (is_list) name = json_array_get(name, 0);
    snprintf(buffer, size, "%s%s", name ? json_string_value(name) : "", is_list ? ", ..." : "");
}

/* The kind of a camera or light, else the keys that are set. */
static void write_detail(const json_t *element, char *buffer, size_t size)
{
    const char *key, *kind = json_string_value(json_object_get(element, "kind"));
    size_t used = 0;
    json_t *value;
    buffer[0] = 0;
    if (kind) {
        snprintf(buffer, size, "%s", kind);
        return;
    }
    json_object_foreach((json_t *)element, key, value)
    {
        const bool is_shown = key[0] != '_' && strcmp(key, "match") != 0;
        if (!is_shown || used + 1 >= size) continue;
        const bool is_preset = strcmp(key, "preset") == 0;
        const int n = snprintf(buffer + used, size - used, "%s%s%s%s", used ? ", " : "", key,
                               is_preset ? " " : "", is_preset ? json_string_value(value) : "");
        used += n > 0 ? (size_t)n : 0;
    }
}

static ppm_status list_element(ppm_setup *setup, uint32_t part, const json_t *element)
{
    char name[200], detail[200];
    write_name(element, name, sizeof name);
    write_detail(element, detail, sizeof detail);
    if (part == PPM_SETUP_CAMERAS) {
        const char *kind = json_string_value(json_object_get(element, "kind"));
        snprintf(detail, sizeof detail, "%s", kind ? kind : "perspective");
    }
    return ppmi_setup_add_entry(setup, part, name, detail);
}

static ppm_status list_sections(ppm_setup *setup)
{
    ppm_status status = PPM_STATUS_OK;
    for (size_t i = 0; i < SECTION_COUNT && status == PPM_STATUS_OK; i++) {
        const json_t *json = json_object_get(setup->root, sections[i].name);
        if (!json || sections[i].part == 0) continue;
        if (!sections[i].is_list) status = list_element(setup, sections[i].part, json);
        for (size_t k = 0; k < json_array_size(json) && status == PPM_STATUS_OK; k++)
            status = list_element(setup, sections[i].part, json_array_get(json, k));
    }
    return status;
}

/* ---- opening --------------------------------------------------------------------------------- */

/* The whole file; the caller's. */
static ppm_status read_bytes(ppm_setup *setup, char **out_bytes, size_t *out_count)
{
    enum { MOST = 64 << 20 };
    struct stat found;
    FILE *file = fopen(setup->path, "rb");
    if (!file || fstat(fileno(file), &found) != 0 || S_ISDIR(found.st_mode)) {
        const char *reason = file ? "it is a folder" : strerror(errno);
        if (file) fclose(file);
        return ppmi_fail(setup->context, PPM_STATUS_INPUT_NOT_FOUND, "%s: cannot read: %s",
                         setup->path, reason);
    }
    ppm_status status = PPM_STATUS_OK;
    char *bytes = NULL;
    if (found.st_size > MOST) {
        status = ppmi_fail(setup->context, PPM_STATUS_INPUT_INVALID,
                           "%s: %lld bytes found, expected at most %d", setup->path,
                           (long long)found.st_size, MOST);
    } else {
        bytes = ppmi_alloc(setup->context, (size_t)found.st_size + 1, 1);
        if (!bytes) status = ppmi_setup_out_of_memory(setup);
    }
    if (bytes) *out_count = fread(bytes, 1, (size_t)found.st_size, file);
    *out_bytes = bytes;
    fclose(file);
    return status;
}

/* Some editors begin a file with a byte order mark. */
static ppm_status parse(ppm_setup *setup)
{
    static const char mark[] = "\xef\xbb\xbf";
    char *bytes = NULL;
    size_t count = 0;
    json_error_t error;
    ppm_status status = read_bytes(setup, &bytes, &count);
    if (status != PPM_STATUS_OK) return status;
    const size_t skipped = count >= 3 && memcmp(bytes, mark, 3) == 0 ? 3 : 0;
    setup->root = json_loadb(bytes + skipped, count - skipped, JSON_REJECT_DUPLICATES, &error);
    ppmi_free(setup->context, bytes);
    if (setup->root) return PPM_STATUS_OK;
    return ppmi_fail(setup->context, PPM_STATUS_INPUT_INVALID, "%s: line %d, column %d: %s",
                     setup->path, error.line, error.column, error.text);
}

ppm_status ppm_setup_open(ppm_context *context, const char *path, const ppm_setup_options *options,
                          ppm_setup **out_setup)
{
    if (!context || !path || !out_setup || (options && options->size < sizeof *options)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppm_setup *setup = ppmi_alloc_zeroed(context, 1, sizeof *setup);
    if (!setup) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    setup->context = context;
    setup->allows_outside = options && options->allow_outside;
    setup->path = ppmi_string_copy(context, path);
    ppm_status status = setup->path ? parse(setup) : PPM_STATUS_OUT_OF_MEMORY;
    if (!setup->path) ppmi_fail(context, status, "%s: out of memory", path);
    if (status == PPM_STATUS_OK) status = check(setup);
    if (status == PPM_STATUS_OK) status = list_sections(setup);
    if (status != PPM_STATUS_OK) {
        ppm_setup_close(setup);
        return status;
    }
    *out_setup = setup;
    return PPM_STATUS_OK;
}

ppm_status ppm_setup_open_beside(ppm_context *context, const char *model_path,
                                 const ppm_setup_options *options, ppm_setup **out_setup)
{
    struct stat found;
    if (!context || !model_path || !out_setup) return PPM_STATUS_INVALID_ARGUMENT;
    const char *slash = strrchr(model_path, '/'), *dot = strrchr(model_path, '.');
    const size_t length =
        dot && (!slash || dot > slash) ? (size_t)(dot - model_path) : strlen(model_path);
    char *path = ppmi_alloc(context, length + sizeof ending, 1);
    if (!path) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", model_path);
    }
    memcpy(path, model_path, length);
    strcpy(path + length, ending);
    ppm_status status = PPM_STATUS_OK;
    *out_setup = NULL;
    if (stat(path, &found) == 0) status = ppm_setup_open(context, path, options, out_setup);
    ppmi_free(context, path);
    return status;
}

/* ---- closing --------------------------------------------------------------------------------- */

/* What belongs to one scene. */
static void forget_scene(ppm_setup *setup)
{
    for (size_t i = 0; i < setup->image_count; i++)
        ppmi_free(setup->context, setup->images[i].path);
    setup->image_count = setup->clone_count = 0;
    setup->first_camera = 0;
    setup->scene = NULL;
}

void ppm_setup_close(ppm_setup *setup)
{
    if (!setup) return;
    ppm_context *context = setup->context;
    forget_scene(setup);
    for (size_t i = 0; i < setup->entry_count; i++) {
        ppmi_free(context, setup->entries[i].name);
        ppmi_free(context, setup->entries[i].detail);
    }
    json_decref(setup->root);
    ppmi_free(context, setup->entries);
    ppmi_free(context, setup->images);
    ppmi_free(context, setup->clones);
    ppmi_free(context, setup->overridden);
    ppmi_free(context, setup->is_told);
    ppmi_free(context, setup->path);
    ppmi_free(context, setup);
}

/* ---- applying -------------------------------------------------------------------------------- */

static ppm_status apply_section(ppm_setup *setup, size_t index)
{
    const ppmi_setup_value root = {.setup = setup, .json = setup->root};
    const json_t *json = json_object_get(setup->root, sections[index].name);
    const ppmi_setup_key key = {.field = index};
    if (!json) return PPM_STATUS_OK;
    const ppmi_setup_value value = ppmi_setup_member(&root, sections[index].name, json);
    return read_section(&value, &key, NULL);
}

ppm_status ppm_setup_apply(ppm_setup *setup, ppm_scene *scene, uint32_t parts)
{
    if (!setup || !scene || parts & ~(uint32_t)PPM_SETUP_ALL) return PPM_STATUS_INVALID_ARGUMENT;
    ppm_status status = PPM_STATUS_OK;
    forget_scene(setup);
    setup->scene = scene;
    for (size_t i = 0; i < SECTION_COUNT && status == PPM_STATUS_OK; i++) {
        if (sections[i].part & parts) status = apply_section(setup, i);
        const bool is_after =
            sections[i].part == PPM_SETUP_MATERIALS && parts & PPM_SETUP_MATERIALS;
        if (status == PPM_STATUS_OK && is_after) status = ppmi_setup_remember_materials(setup);
    }
    setup->applied_parts = parts;
    return status;
}

ppm_status ppm_setup_reapply(ppm_setup *setup, ppm_scene *scene)
{
    if (!setup || !scene) return PPM_STATUS_INVALID_ARGUMENT;
    if (setup->scene != scene) {
        return ppmi_fail(setup->context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s: it has not been applied to this scene", setup->path);
    }
    ppm_status status = PPM_STATUS_OK;
    if (setup->applied_parts & PPM_SETUP_MATERIALS) status = ppmi_setup_restore_materials(setup);
    if (status == PPM_STATUS_OK && setup->applied_parts & PPM_SETUP_NODES) {
        status = ppmi_setup_restore_nodes(setup);
    }
    return status;
}

ppm_camera_id ppm_setup_camera(const ppm_setup *setup)
{
    return setup ? setup->first_camera : 0;
}

/* ---- facts ----------------------------------------------------------------------------------- */

const char *ppm_setup_path(const ppm_setup *setup)
{
    return setup ? setup->path : "";
}

uint32_t ppm_setup_count(const ppm_setup *setup)
{
    return setup ? (uint32_t)setup->entry_count : 0;
}

ppm_status ppm_setup_get_item(const ppm_setup *setup, uint32_t index, ppm_setup_item *out_item)
{
    if (!setup || !out_item || out_item->size < sizeof *out_item || index >= setup->entry_count) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const ppmi_setup_entry *entry = &setup->entries[index];
    *out_item = (ppm_setup_item){
        .size = out_item->size, .part = entry->part, .name = entry->name, .detail = entry->detail};
    return PPM_STATUS_OK;
}

/* Render options come first: "render" is listed as it is checked. */
uint32_t ppm_setup_option_count(const ppm_setup *setup)
{
    uint32_t count = 0;
    while (setup && count < setup->entry_count && setup->entries[count].part == 0)
        count++;
    return count;
}

ppm_status ppm_setup_get_option(const ppm_setup *setup, uint32_t index, const char **out_name,
                                const char **out_value)
{
    if (!out_name || !out_value || index >= ppm_setup_option_count(setup)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    *out_name = setup->entries[index].name;
    *out_value = setup->entries[index].detail;
    return PPM_STATUS_OK;
}
