/* Files that are broken at random: an import ends in a status and, where it fails, a message that
 * names the file. The same random numbers in every run. */
#include <string.h>

#include "obj_fixture.h"

enum { RUNS = 400, MOST_EDITS = 6, ROOM = 4096 };

static const char document[] =
    "# comment\nmtllib scene.mtl\no a b\ng c\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0.1 2e-1 0\n"
    "v 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl m\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\n"
    "f -5/-3/-1 -4/-2/-1 \\\n-3/-1/-1\ns off\nusemtl n\nf 1//1 2//1 5\nf 1/2 3/3 5/1\n"
    "l 1/1 2/2 3\np 1 2\nusemtl o\nf 5 4 3 2 1\ncurv 0 1 1 2\n";
static const char library[] =
    "newmtl m\nKd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 100\nd 0.5\nillum 2\nmap_Kd -s 2 2 -o 0.1 a.ppm\n"
    "map_d -imfchan m a.ppm\nmap_Pr -mm 0 0.5 a.ppm\nmap_Pm b.ppm\nbump -bm 2 b.ppm\n"
    "newmtl n\nillum 7\nNi 1.5\nTf 1 0.5 0.5\nmap_Tf a.ppm\nPc 1\nPcr 0.5\nPs 0.5\nmap_Ps b.ppm\n"
    "newmtl o\nKe 1 1 1\nmap_Ke a.ppm\naniso 0.5\nanisor 0.1\nmap_aniso a.ppm\nmap_anisor b.ppm\n"
    "map_Ns a.ppm\nrefl x.ppm\n";

/* xorshift32 (Marsaglia 2003). */
static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

/* One byte changed, a piece taken out, or a piece put in once more. */
static size_t edit(char *text, size_t length, uint32_t *random)
{
    static const char signs[] = "0123456789/-+.eE \t\n\r\\#vfnlpgsot\xff\x01m";
    const size_t at = next_random(random) % length, most = length - at;
    const size_t count = 1 + next_random(random) % (most < 24 ? most : 24);
    switch (next_random(random) % 3) {
    case 0:
        text[at] = signs[next_random(random) % (sizeof signs - 1)];
        return length;
    case 1:
        if (count + 16 > length) return length;
        memmove(text + at, text + at + count, length - at - count);
        return length - count;
    default:
        if (length + count > ROOM) return length;
        memmove(text + at + count, text + at, length - at);
        return length + count;
    }
}

static size_t mutate(char *text, const char *from, size_t length, uint32_t *random)
{
    memcpy(text, from, length);
    for (uint32_t edits = next_random(random) % MOST_EDITS; edits > 0; --edits) {
        length = edit(text, length, random);
    }
    return length;
}

static void broken_files_end_in_a_status_and_a_message(void **state)
{
    obj_fixture *f = *state;
    static char text[ROOM];
    uint32_t random = 20;
    size_t read = 0;
    obj_write(f, "sub/a.ppm", "P6 2 2 255\nabcdefghijkl", 23);
    obj_write(f, "sub/b.ppm", "P6 1 2 255\nABCDEF", 17);
    for (int i = 0; i < RUNS; ++i) {
        f->options.crease_rad = i % 2 == 0 ? 1.0f : 0.0f;
        const size_t mtl = mutate(text, library, sizeof library - 1, &random);
        obj_write(f, "sub/scene.mtl", text, mtl);
        const size_t obj = mutate(text, document, sizeof document - 1, &random);
        const ppm_status status = obj_import_bytes(f, text, obj);
        read += status == PPM_STATUS_OK;
        if (status == PPM_STATUS_OK) continue;
        if (status != PPM_STATUS_INPUT_INVALID || !obj_logged(f, 'E', "sub/scene.obj: ")) {
            fail_msg("run %d: %s\n%s\n%.*s", i, ppm_status_name(status), f->log, (int)obj, text);
        }
    }
    assert_true(read > RUNS / 4); /* both ends are reached */
    assert_true(read < RUNS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(broken_files_end_in_a_status_and_a_message, obj_setup,
                                        obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
