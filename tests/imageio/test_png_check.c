/* Broken PNG files are recognised before a decoder sees them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "imageio/imageio.h"
#include "imageio/png_check.h"

/* One black pixel: signature, IHDR at 8, IDAT at 33, IEND at 55. */
static const uint8_t smallest[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
    0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0x60, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01, 0x48, 0xaf, 0xa4, 0x71, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
};
enum { FIRST_CHUNK_AT = 8, IDAT_AT = 33, IEND_AT = 55 };

static ppm_status check(const uint8_t *bytes, size_t byte_count)
{
    return ppmi_imageio_png_check(NULL, bytes, byte_count, "test.png");
}

static void a_whole_file_passes_and_can_be_decoded(void **state)
{
    (void)state;
    assert_int_equal(check(smallest, sizeof smallest), PPM_STATUS_OK);
    ppmi_pixels pixels;
    assert_int_equal(ppmi_imageio_read_memory(NULL, smallest, sizeof smallest, "test.png", &pixels),
                     PPM_STATUS_OK);
    assert_int_equal(pixels.width, 1);
    assert_int_equal(pixels.channels, 1);
    assert_int_equal(pixels.u8[0], 0);
    ppmi_imageio_pixels_free(NULL, &pixels);
}

static void bytes_after_the_end_are_no_fault(void **state)
{
    (void)state;
    uint8_t longer[sizeof smallest + 5] = {0};
    memcpy(longer, smallest, sizeof smallest);
    assert_int_equal(check(longer, sizeof longer), PPM_STATUS_OK);
}

static void every_shorter_file_is_refused(void **state)
{
    (void)state;
    for (size_t size = FIRST_CHUNK_AT; size < sizeof smallest; size++) {
        assert_int_equal(check(smallest, size), PPM_STATUS_INPUT_INVALID);
    }
}

static void every_flipped_bit_is_found(void **state)
{
    (void)state;
    for (size_t i = FIRST_CHUNK_AT; i < sizeof smallest; i++) {
        for (int bit = 0; bit < 8; bit++) {
            uint8_t damaged[sizeof smallest];
            memcpy(damaged, smallest, sizeof damaged);
            damaged[i] ^= (uint8_t)(1 << bit);
            assert_int_equal(check(damaged, sizeof damaged), PPM_STATUS_INPUT_INVALID);
        }
    }
}

static void chunk_types_are_letters(void **state)
{
    (void)state;
    /* an unneeded chunk: length 0, a type with a digit, no checksum */
    static const uint8_t chunk[12] = {0, 0, 0, 0, 't', 'E', '1', 't'};
    uint8_t longer[sizeof smallest + sizeof chunk];
    memcpy(longer, smallest, IDAT_AT);
    memcpy(longer + IDAT_AT, chunk, sizeof chunk);
    memcpy(longer + IDAT_AT + sizeof chunk, smallest + IDAT_AT, sizeof smallest - IDAT_AT);
    assert_int_equal(check(longer, sizeof longer), PPM_STATUS_INPUT_INVALID);
    longer[IDAT_AT + 6] = 'X';
    assert_int_equal(check(longer, sizeof longer), PPM_STATUS_OK);
}

static void pixels_must_be_there(void **state)
{
    (void)state;
    uint8_t empty[sizeof smallest];
    memcpy(empty, smallest, IDAT_AT);
    memcpy(empty + IDAT_AT, smallest + IEND_AT, sizeof smallest - IEND_AT);
    assert_int_equal(check(empty, sizeof smallest - (IEND_AT - IDAT_AT)), PPM_STATUS_INPUT_INVALID);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_file_passes_and_can_be_decoded),
        cmocka_unit_test(bytes_after_the_end_are_no_fault),
        cmocka_unit_test(every_shorter_file_is_refused),
        cmocka_unit_test(every_flipped_bit_is_found),
        cmocka_unit_test(chunk_types_are_letters),
        cmocka_unit_test(pixels_must_be_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
