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

/* Writes over part, of a folder, what is there under that name in other letter case; the first one
 * in the order of characters if there are several. */
static bool match_case(const char *folder, char *part, size_t length)
{
    char best[256];
    bool is_found = false;
    DIR *directory = length < sizeof best ? opendir(folder[0] ? folder : ".") : NULL;
    if (!directory) return false;
    for (const struct dirent *entry; (entry = readdir(directory));) {
        const char *name = entry->d_name;
        if (strlen(name) != length || strncasecmp(name, part, length) != 0) continue;
        if (is_found && strcmp(name, best) >= 0) continue;
        memcpy(best, name, length + 1);
        is_found = true;
    }
    closedir(directory);
    if (is_found) memcpy(part, best, length);
    return is_found;
}

/* Brings the letter case of path, behind its first `fixed` bytes, to what is on the disk. False if
 * there is no such file. */
static bool resolve(char *path, size_t fixed)
{
    struct stat info;
    for (char *part = path + fixed; *part;) {
        char *end = part + strcspn(part, "/");
        const char mark = *end;
        *end = 0;
        bool is_there = *part == 0 || stat(path, &info) == 0;
        if (!is_there) {
            char saved = *part;
            char *copy = part;
            /* the folder is the path up to here */
            *copy = 0;
            char name[256];
            const size_t length = (size_t)(end - part);
            is_there = false;
            if (length < sizeof name) {
                name[0] = saved;
                memcpy(name + 1, part + 1, length - 1);
                is_there = match_case(path, name, length);
                memcpy(part, name, length);
            } else {
                *copy = saved;
            }
        }
        *end = mark;
        if (!is_there) return false;
        part = end + (mark == '/');
    }
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}
