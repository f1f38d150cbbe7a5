/* Where the files are that an OBJ names. Names come from other systems: with backslashes, in other
 * letter case, with folders that are not here. */
#include <dirent.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "obj/obj_reader.h"

size_t ppmi_obj_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Whether the parts of a relative path never go above where they start. */
static bool stays_inside(const char *path)
{
    int depth = 0;
    while (*path) {
        const size_t length = strcspn(path, "/");
        if (length == 2 && path[0] == '.' && path[1] == '.') {
            if (--depth < 0) return false;
        } else if (length > 0 && !(length == 1 && path[0] == '.')) {
            ++depth;
        }
        path += length;
        path += *path == '/';
    }
    return depth > 0;
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

/* One search, in its own memory. */
typedef struct search {
    const char *obj;    /* path of the OBJ */
    const char *folder; /* of the library, relative to it */
    char *name;         /* with slashes */
    char *wanted;       /* what is tried: folder and name, relative to the OBJ's folder */
    char *path;         /* what was found */
} search;

/* Tries first_part + rest, which must stay inside the OBJ's folder. */
static bool try_path(search *s, const char *first_part, const char *rest)
{
    const size_t first = strlen(first_part), root = ppmi_obj_folder_length(s->obj);
    memcpy(s->wanted, first_part, first);
    strcpy(s->wanted + first, rest);
    if (!stays_inside(s->wanted)) return false;
    memcpy(s->path, s->obj, root);
    return resolve(s->path, root, s->wanted);
}

static bool find(search *s)
{
    const char *base = s->name + ppmi_obj_folder_length(s->name);
    if (!is_absolute(s->name)) {
        if (try_path(s, s->folder, s->name) || try_path(s, "", s->name)) return true;
    }
    return try_path(s, s->folder, base) || try_path(s, "", base);
}

/* Whether path is what folder and name say, letter by letter. */
static bool is_as_written(const search *s)
{
    const char *relative = s->path + ppmi_obj_folder_length(s->obj);
    const size_t length = strlen(s->folder);
    return strncmp(relative, s->folder, length) == 0 && strcmp(relative + length, s->name) == 0;
}

ppm_status ppmi_obj_find_file(ppmi_obj_reader *r, const char *folder, const char *name,
                              char **out_path, bool *out_is_elsewhere)
{
    const size_t name_size = strlen(name) + 1, wanted_size = name_size + strlen(folder);
    search s = {.obj = r->path, .folder = folder};
    *out_path = NULL;
    s.name = ppmi_alloc(r->context, name_size, 1);
    s.wanted = ppmi_alloc(r->context, wanted_size, 1);
    s.path = ppmi_alloc(r->context, wanted_size + ppmi_obj_folder_length(r->path), 1);
    const bool ok = s.name && s.wanted && s.path;
    if (ok) {
        for (size_t i = 0; i < name_size; ++i) {
            s.name[i] = (char)(name[i] == '\\' ? '/' : name[i]);
        }
        if (find(&s)) {
            *out_is_elsewhere = !is_as_written(&s);
            *out_path = s.path;
            s.path = NULL;
        }
    }
    ppmi_free(r->context, s.name);
    ppmi_free(r->context, s.wanted);
    ppmi_free(r->context, s.path);
    return ok ? PPM_STATUS_OK : ppmi_obj_out_of_memory(r);
}
