/* Where the files are that an OBJ names. Names come from other systems: with backslashes, in other
 * letter case, with folders that are not here. */
#include <dirent.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/path.h"
#include "obj/obj_reader.h"

size_t ppmi_obj_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static bool is_absolute(const char *name)
{
    const bool is_letter = (name[0] >= 'a' && name[0] <= 'z') || (name[0] >= 'A' && name[0] <= 'Z');
    return name[0] == '/' || (is_letter && name[1] == ':');
}

/* Puts the name in folder that is `part` but for letter case at folder + at, the first one in the
 * order of characters if there are several. */
static bool match_case(char *folder, size_t at, const char *part, size_t length)
{
    bool is_found = false;
    folder[at] = 0;
    DIR *directory = opendir(at > 0 ? folder : ".");
    if (!directory) return false;
    for (const struct dirent *entry; (entry = readdir(directory));) {
        const char *name = entry->d_name;
        if (strlen(name) != length || strncasecmp(name, part, length) != 0) continue;
        if (is_found && strcmp(name, folder + at) >= 0) continue;
        memcpy(folder + at, name, length + 1);
        is_found = true;
    }
    closedir(directory);
    return is_found;
}

/* Appends a relative name to out, which holds at bytes and has room, part by part in the letter
 * case that is on the disk. False if there is no such file. */
static bool resolve(char *out, size_t at, const char *name)
{
    struct stat info;
    while (*name) {
        const size_t length = strcspn(name, "/");
        memcpy(out + at, name, length);
        out[at + length] = 0;
        if (length > 0 && stat(out, &info) != 0 && !match_case(out, at, name, length)) return false;
        at += length;
        name += length;
        if (*name == '/') out[at++] = *name++;
    }
    out[at] = 0;
    return stat(out, &info) == 0 && S_ISREG(info.st_mode);
}

/* A place to look in: nothing above root is read. */
typedef struct place {
    const char *root; /* length bytes: "" or with a slash at its end */
    size_t root_length;
    const char *below; /* a folder in it, in the same form */
    size_t below_length;
    bool needs_slash; /* the root was written without one */
} place;

/* One search, in its own memory. */
typedef struct search {
    const ppmi_obj_reader *reader;
    char *name;   /* with slashes */
    char *wanted; /* what is tried: relative to the root */
    char *path;   /* what was found */
} search;

/* Tries a name in a place, which must not climb out of its root. */
static bool try_name(search *s, const place *where, const char *name)
{
    memcpy(s->wanted, where->below, where->below_length);
    strcpy(s->wanted + where->below_length, name);
    if (!s->reader->options->allow_outside && !ppmi_path_stays_inside(s->wanted)) return false;
    size_t at = where->root_length;
    memcpy(s->path, where->root, at);
    if (where->needs_slash) s->path[at++] = '/';
    return resolve(s->path, at, s->wanted);
}

/* The rest of a path without its first part; "" behind the last one. */
static const char *without_first_part(const char *path)
{
    path += strcspn(path, "/");
    while (*path == '/') {
        ++path;
    }
    return path;
}

static bool try_shorter(search *s, const place *places, size_t count, const char *name)
{
    while (*(name = without_first_part(name))) {
        for (size_t i = 0; i < count; ++i) {
            if (try_name(s, &places[i], name)) return true;
        }
    }
    return false;
}

/* As the name says, then by ever shorter ends of it. */
static bool try_places(search *s, const place *places, size_t count)
{
    for (size_t i = 0; i < count && !is_absolute(s->name); ++i) {
        if (try_name(s, &places[i], s->name)) return true;
    }
    return try_shorter(s, places, count, s->name);
}

/* The folder of the file that names it: below that of the OBJ, or one of a texture path. */
static place folder_place(const ppmi_obj_reader *r, const char *folder, size_t length)
{
    const size_t root = ppmi_obj_folder_length(r->path);
    const bool is_below = length >= root && memcmp(folder, r->path, root) == 0;
    if (!is_below) return (place){.root = folder, .root_length = length, .below = ""};
    return (place){.root = r->path,
                   .root_length = root,
                   .below = folder + root,
                   .below_length = length - root};
}

static bool find(search *s, const place *beside)
{
    const ppm_import_options *options = s->reader->options;
    if (options->allow_outside && s->name[0] == '/' && resolve(s->path, 0, s->name)) return true;
    if (try_places(s, beside, 2)) return true;
    for (uint32_t i = 0; i < options->texture_folder_count; ++i) {
        const char *folder = options->texture_folders[i];
        const size_t length = strlen(folder);
        const place there = {.root = folder,
                             .root_length = length,
                             .below = "",
                             .needs_slash = length > 0 && folder[length - 1] != '/'};
        if (try_places(s, &there, 1)) return true;
    }
    return false;
}

/* Whether the path found is what folder and name say, letter by letter. */
static bool is_as_written(const search *s, const char *folder, size_t length)
{
    if (s->name[0] == '/') return strcmp(s->path, s->name) == 0;
    return strncmp(s->path, folder, length) == 0 && strcmp(s->path + length, s->name) == 0;
}

/* The longest folder that a name may be looked for in. */
static size_t longest_folder(const ppmi_obj_reader *r, size_t length)
{
    const ppm_import_options *options = r->options;
    const size_t root = ppmi_obj_folder_length(r->path);
    size_t most = length > root ? length : root;
    for (uint32_t i = 0; i < options->texture_folder_count; ++i) {
        const size_t other = strlen(options->texture_folders[i]) + 1;
        most = other > most ? other : most;
    }
    return most;
}

ppm_status ppmi_obj_find_file(ppmi_obj_reader *r, const char *beside, const char *name,
                              char **out_path, bool *out_is_elsewhere)
{
    const size_t name_size = strlen(name) + 1, length = ppmi_obj_folder_length(beside);
    const size_t size = name_size + longest_folder(r, length);
    const place places[2] = {folder_place(r, beside, length),
                             folder_place(r, r->path, ppmi_obj_folder_length(r->path))};
    search s = {.reader = r};
    *out_path = NULL;
    s.name = ppmi_alloc(r->context, name_size, 1);
    s.wanted = ppmi_alloc(r->context, size, 1);
    s.path = ppmi_alloc(r->context, size, 1);
    const bool ok = s.name && s.wanted && s.path;
    if (ok) {
        for (size_t i = 0; i < name_size; ++i) {
            s.name[i] = (char)(name[i] == '\\' ? '/' : name[i]);
        }
        if (find(&s, places)) {
            *out_is_elsewhere = !is_as_written(&s, beside, length);
            *out_path = s.path;
            s.path = NULL;
        }
    }
    ppmi_free(r->context, s.name);
    ppmi_free(r->context, s.wanted);
    ppmi_free(r->context, s.path);
    return ok ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
}
