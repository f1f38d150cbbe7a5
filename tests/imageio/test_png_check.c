/* Broken PNG files are recognised before a decoder sees them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
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

/* CRC-32 of the chunk's type and data, bit by bit (W3C PNG, annex D). */
static void put_checksum(uint8_t *chunk)
{
    const size_t length = chunk[3];
    uint32_t crc = 0xffffffff;
    for (size_t i = 4; i < 8 + length; i++) {
        crc ^= chunk[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    for (size_t i = 0; i < 4; i++)
        chunk[8 + length + i] = (uint8_t)(~crc >> (24 - 8 * i));
}

static ppm_status check(const uint8_t *bytes, size_t byte_count)
{
    size_t cut_at;
    return ppmi_imageio_png_check(NULL, bytes, byte_count, "test.png", &cut_at);
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

static void a_file_without_all_of_its_pixels_is_refused(void **state)
{
    (void)state;
    for (size_t size = FIRST_CHUNK_AT; size < IEND_AT; size++) {
        assert_int_equal(check(smallest, size), PPM_STATUS_INPUT_INVALID);
    }
}

/* The pixel is 0 in smallest; here one of 200 is decoded from what is left of its file. */
static void a_file_that_lacks_only_its_end_is_read(void **state)
{
    (void)state;
    /* zlib's stream of the filter byte and 200, stored: adler-32 is 0x00ca00c9 */
    static const uint8_t idat[] = {0x00, 0x00, 0x00, 0x0d, 'I',  'D',  'A',  'T',  0x78,
                                   0x01, 0x01, 0x02, 0x00, 0xfd, 0xff, 0x00, 0xc8, 0x00,
                                   0xca, 0x00, 0xc9, 0,    0,    0,    0};
    /* the beginning of a comment */
    static const uint8_t text[] = {0, 0, 0, 9, 't', 'E', 'X', 't', 'C', 'o', 'm', 'm', 'e'};
    uint8_t file[IDAT_AT + sizeof idat + PPMI_PNG_END_BYTES + sizeof text];
    memcpy(file, smallest, IDAT_AT);
    memcpy(file + IDAT_AT, idat, sizeof idat);
    put_checksum(file + IDAT_AT);
    const size_t end = IDAT_AT + sizeof idat;
    for (size_t i = 0; i < PPMI_PNG_END_BYTES + sizeof text; i++) {
        const bool is_text = i >= PPMI_PNG_END_BYTES;
        const size_t length = is_text ? i - PPMI_PNG_END_BYTES : i;
        size_t cut_at;
        ppmi_pixels pixels = {0};
        memcpy(file + end, is_text ? text : ppmi_imageio_png_end, length);
        assert_int_equal(ppmi_imageio_png_check(NULL, file, end + length, "test.png", &cut_at),
                         PPM_STATUS_OK);
        assert_int_equal(cut_at, end);
        assert_int_equal(ppmi_imageio_read_memory(NULL, file, end + length, "test.png", &pixels),
                         PPM_STATUS_OK);
        assert_true(pixels.is_cut);
        assert_int_equal(pixels.u8[0], 200);
        ppmi_imageio_pixels_free(NULL, &pixels);
    }
}

/* A file that ends between two chunks of pixels is for the decoder to refuse, which leaks nothing.
 */
static void a_file_that_ends_between_chunks_of_pixels_is_refused(void **state)
{
    (void)state;
    uint8_t file[IDAT_AT + 12 + 8];
    memcpy(file, smallest, IDAT_AT);
    memcpy(file + IDAT_AT, smallest + IDAT_AT, 16); /* length, type, the first 8 of 10 bytes */
    file[IDAT_AT + 3] = 8;
    put_checksum(file + IDAT_AT);
    ppmi_pixels pixels = {0};
    size_t cut_at;
    assert_int_equal(ppmi_imageio_png_check(NULL, file, sizeof file, "test.png", &cut_at),
                     PPM_STATUS_OK);
    assert_int_equal(cut_at, sizeof file);
    const ppm_status status =
        ppmi_imageio_read_memory(NULL, file, sizeof file, "test.png", &pixels);
    ppmi_imageio_pixels_free(NULL, &pixels);
    assert_int_equal(status, PPM_STATUS_INPUT_INVALID);
}

static void every_flipped_bit_is_found(void **state)
{
    (void)state;
    for (size_t i = FIRST_CHUNK_AT; i < sizeof smallest; i++) {
        for (int bit = 0; bit < 8; bit++) {
            uint8_t damaged[sizeof smallest];
            memcpy(damaged, smallest, sizeof damaged);
            damaged[i] ^= (uint8_t)(1 << bit);
            size_t cut_at;
            const ppm_status status =
                ppmi_imageio_png_check(NULL, damaged, sizeof damaged, "test.png", &cut_at);
            /* a last chunk that is too long lacks its end; so does a file with iEND in its place */
            const bool lacks_end = i >= IEND_AT && i < IEND_AT + 5 && cut_at >= IEND_AT;
            assert_int_equal(status, lacks_end ? PPM_STATUS_OK : PPM_STATUS_INPUT_INVALID);
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
        cmocka_unit_test(a_file_without_all_of_its_pixels_is_refused),
        cmocka_unit_test(a_file_that_lacks_only_its_end_is_read),
        cmocka_unit_test(a_file_that_ends_between_chunks_of_pixels_is_refused),
        cmocka_unit_test(every_flipped_bit_is_found),
        cmocka_unit_test(chunk_types_are_letters),
        cmocka_unit_test(pixels_must_be_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
