#include "base/path.h"

#include <string.h>

bool ppmi_path_stays_inside(const char *path)
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
