/* URIs: RFC 2397 for data, RFC 3986 for the rest. A file that somebody sends must not make us read
 * outside of its folder, so only relative paths that stay inside are files, unless the caller
 * trusts the file (allow_outside); symbolic links in the folder are its owner's affair. Nothing is
 * ever fetched from a network. */
#include "gltf/gltf_uri.h"
#include "base/path.h"

#include <stdint.h>
#include <string.h>
#include <unistd.h>

static bool equals_ignoring_case(const char *a, const char *b, size_t length)
{
    for (size_t i = 0; i < length; ++i) {
        const char lower = (char)(a[i] >= 'A' && a[i] <= 'Z' ? a[i] + 32 : a[i]);
        if (lower != b[i]) return false;
    }
    return true;
}

bool ppmi_gltf_uri_is_data(const char *uri, size_t length)
{
    return length >= 5 && equals_ignoring_case(uri, "data:", 5);
}

static ppm_status refuse(const char *reason, const char **out_reason)
{
    *out_reason = reason;
    return PPM_STATUS_INPUT_INVALID;
}

static int hex_value(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/* Decodes %XX; other percent signs stay. out holds length bytes. Returns how many are used. */
static size_t percent_decode(const char *text, size_t length, char *out)
{
    size_t count = 0;
    for (size_t i = 0; i < length; ++i) {
        const bool is_escape = text[i] == '%' && length - i > 2 && hex_value(text[i + 1]) >= 0 &&
                               hex_value(text[i + 2]) >= 0;
        if (is_escape) {
            out[count++] = (char)(hex_value(text[i + 1]) * 16 + hex_value(text[i + 2]));
            i += 2;
        } else {
            out[count++] = text[i];
        }
    }
    return count;
}

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62; /* - and _: base64url */
    if (c == '/' || c == '_') return 63;
    return -1;
}

/* False for a character that is none of base64's. out holds length * 3 / 4 bytes. */
static bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *out_count)
{
    uint32_t bits = 0;
    unsigned bit_count = 0;
    size_t count = 0;
    while (length > 0 && text[length - 1] == '=') {
        --length;
    }
    for (size_t i = 0; i < length; ++i) {
        const int value = base64_value(text[i]);
        if (value < 0) return false;
        bits = bits << 6 | (uint32_t)value;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            out[count++] = (unsigned char)(bits >> bit_count);
        }
    }
    *out_count = count;
    return true;
}

ppm_status ppmi_gltf_uri_decode_data(ppm_context *context, const char *uri, size_t length,
                                     unsigned char **out_bytes, size_t *out_count,
                                     const char **out_reason)
{
    static const char base64[] = ";base64";
    const size_t mark = sizeof base64 - 1;
    *out_bytes = NULL;
    *out_count = 0;
    const char *comma = memchr(uri, ',', length);
    if (!comma) return refuse("the data URI has no comma", out_reason);
    const size_t header = (size_t)(comma - uri), rest = length - header - 1;
    if (rest == 0) return PPM_STATUS_OK;
    unsigned char *bytes = ppmi_alloc(context, rest, 1);
    if (!bytes) return PPM_STATUS_OUT_OF_MEMORY;
    const bool is_base64 = header >= mark && equals_ignoring_case(comma - mark, base64, mark);
    if (!is_base64) {
        *out_count = percent_decode(comma + 1, rest, (char *)bytes);
    } else if (!base64_decode(comma + 1, rest, bytes, out_count)) {
        ppmi_free(context, bytes);
        return refuse("the data URI is not base64", out_reason);
    }
    *out_bytes = bytes;
    return PPM_STATUS_OK;
}

/* scheme ":" of RFC 3986, section 3.1. */
static bool has_scheme(const char *uri, size_t length)
{
    for (size_t i = 0; i < length; ++i) {
        const char c = uri[i];
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (c == ':') return i > 0;
        if (i == 0 && !is_letter) return false;
        if (!is_letter && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return false;
    }
    return false;
}

/* The path in file:/path, file:///path or file://localhost/path (RFC 8089); NULL for another
 * machine's. */
static const char *file_uri_path(const char *uri, size_t length)
{
    static const char authority[] = "//", localhost[] = "localhost";
    const char *path = uri + 5, *end = uri + length;
    if (end - path >= 2 && memcmp(path, authority, 2) == 0) {
        path += 2;
        const size_t left = (size_t)(end - path), host = sizeof localhost - 1;
        if (left >= host && equals_ignoring_case(path, localhost, host)) path += host;
    }
    return path < end && *path == '/' ? path : NULL;
}

/* Takes the scheme off; *uri is then a path, percent-encoded. */
static const char *scheme_fault(bool allow_outside, const char **uri, size_t *length)
{
    const char *const begin = *uri;
    if (!has_scheme(begin, *length)) return NULL;
    if (*length >= 5 && equals_ignoring_case(begin, "http", 4)) {
        return "nothing is fetched from a network; save it beside the asset and name that file";
    }
    if (*length < 5 || !equals_ignoring_case(begin, "file:", 5)) {
        return "only files are read, no other URI";
    }
    if (!allow_outside) return "file: URIs are not read, unless files outside are allowed";
    const char *path = file_uri_path(begin, *length);
    if (!path) return "the file: URI names no path of this machine";
    *length -= (size_t)(path - begin);
    *uri = path;
    return NULL;
}

static const char *path_fault(bool allow_outside, const char *path, size_t length)
{
    if (memchr(path, 0, length)) return "the URI holds a zero byte";
    if (allow_outside) return NULL;
    if (path[0] == '/') return "absolute paths are not read, unless files outside are allowed";
    return ppmi_path_stays_inside(path)
               ? NULL
               : "the path leaves the asset's folder; such are read only if files outside are "
                 "allowed";
}

/* Takes "." and "name/.." out of a path (RFC 3986, section 5.2.4), so that it does not matter
 * whether there is a folder of that name. What leads out of the beginning stays. */
static void remove_dot_segments(char *path)
{
    const size_t root = *path == '/';
    size_t to = root, names = 0; /* names: how many of the parts so far ".." can take back */
    for (const char *from = path + root; *from;) {
        const size_t length = strcspn(from, "/"), step = length + (from[length] == '/');
        const bool is_up = length == 2 && from[0] == '.' && from[1] == '.';
        if (is_up && names > 0) {
            for (--to; to > root && path[to - 1] != '/'; --to) {
            }
            --names;
        } else if (length > 0 && !(length == 1 && from[0] == '.')) {
            memmove(path + to, from, step);
            to += step;
            names += !is_up;
        }
        from += step;
    }
    path[to] = 0;
}

/* The file that the first length characters of a URI name; *out_path is the caller's. */
static ppm_status make_path(ppm_context *context, const char *asset_path, bool allow_outside,
                            const char *uri, size_t length, char **out_path,
                            const char **out_reason)
{
    const char *slash = strrchr(asset_path, '/');
    const size_t folder = slash ? (size_t)(slash - asset_path) + 1 : 0;
    char *path = ppmi_alloc(context, folder + length + 1, 1);
    if (!path) return PPM_STATUS_OUT_OF_MEMORY;
    memcpy(path, asset_path, folder);
    char *relative = path + folder;
    const size_t count = percent_decode(uri, length, relative);
    relative[count] = 0;
    for (size_t i = 0; i < count; ++i) {
        if (relative[i] == '\\')
            relative[i] = '/'; /* not legal in a URI; some exporters write it */
    }
    const char *fault = path_fault(allow_outside, relative, count);
    if (fault) {
        ppmi_free(context, path);
        return refuse(fault, out_reason);
    }
    remove_dot_segments(relative);
    if (relative[0] == '/') memmove(path, relative, strlen(relative) + 1);
    *out_path = path;
    return PPM_STATUS_OK;
}

/* A query or fragment (RFC 3986, sections 3.4 and 3.5) says nothing about a file; but there are
 * writers that do not escape the characters of a name. */
ppm_status ppmi_gltf_uri_path(ppm_context *context, const char *asset_path, bool allow_outside,
                              const char *uri, size_t length, char **out_path,
                              const char **out_reason)
{
    *out_path = NULL;
    if (length == 0) return refuse("the URI is empty", out_reason);
    const char *fault = scheme_fault(allow_outside, &uri, &length);
    if (fault) return refuse(fault, out_reason);
    size_t plain = 0;
    while (plain < length && uri[plain] != '?' && uri[plain] != '#')
        ++plain;
    const ppm_status status =
        make_path(context, asset_path, allow_outside, uri, length, out_path, out_reason);
    if (plain == 0 || plain == length) return status;
    if (status == PPM_STATUS_OK && access(*out_path, F_OK) == 0) return status;
    ppmi_free(context, *out_path);
    *out_path = NULL;
    return make_path(context, asset_path, allow_outside, uri, plain, out_path, out_reason);
}
