/* Names, their ids, and their JSON. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "ppm/render.h"
#include "render/crypto_name.h"

static float id_of(const char *name)
{
    const uint32_t bits = ppmi_crypto_id(name);
    float id;
    memcpy(&id, &bits, sizeof id);
    return id;
}

/* From the unit tests of Psyop's Cryptomatte for Nuke (cryptomatte_utilities_tests.py,
 * CryptoHashing); the last two are Bulgarian and German. */
static void ids_are_the_published_ones(void **state)
{
    (void)state;
    assert_true(id_of("hello") == 6.0705627102400005616e-17f);
    assert_true(id_of("cube") == -4.08461912519e+15f);
    assert_true(id_of("sphere") == 2.79018604383e+15f);
    assert_true(id_of("plane") == 3.66557617593e-11f);
    assert_true(id_of("\xd1\x80\xd0\xb0\xd0\xb2\xd0\xbd\xd0\xb8\xd0\xbd\xd0\xb0") ==
                -1.3192631212399999468e-25f);
    assert_true(id_of("m\xc3\xa4"
                      "dchen") == 6.2361298211599995797e+25f);
}

/* From the manifests of Psyop's sample images (bunny_CryptoObject_manifest.json,
 * sidecar_manifest.crypto_asset.json). */
static void ids_are_those_of_published_manifests(void **state)
{
    (void)state;
    assert_int_equal(ppmi_crypto_id("bunny"), 0x13851a76);
    assert_int_equal(ppmi_crypto_id("bush"), 0xf763d090);
    assert_int_equal(ppmi_crypto_id("flowerA.flowerA_petal1.:2261"), 0x00af91ae);
    assert_int_equal(ppmi_crypto_id("default"), 0x42c9679f);
    assert_int_equal(ppmi_crypto_id("default_111"), 0xad58c73a);
    assert_int_equal(ppmi_crypto_id("leftAsset"), 0xce406a47);
}

/* From the header of a picture of the default plane by Blender 3.4. */
static void ids_and_keys_are_blenders(void **state)
{
    (void)state;
    char key[8];
    assert_int_equal(ppmi_crypto_id("Plane"), 0x4159b52a);
    ppm_cryptomatte_key("ViewLayer.CryptoObject", key);
    assert_string_equal(key, "542cafa");
}

/* https://stackoverflow.com/questions/14747343/murmurhash3-test-vectors: every remainder of the
 * length by four, bytes with their highest bit, seeds. */
static void the_hash_takes_any_length_and_seed(void **state)
{
    (void)state;
    assert_int_equal(ppmi_murmur3("", 0, 0), 0);
    assert_int_equal(ppmi_murmur3("", 0, 1), 0x514e28b7);
    assert_int_equal(ppmi_murmur3("", 0, 0xffffffffu), 0x81f16f39);
    assert_int_equal(ppmi_murmur3("\xff\xff\xff\xff", 4, 0), 0x76293b50);
    assert_int_equal(ppmi_murmur3("\x21\x43\x65\x87", 4, 0), 0xf55b516b);
    assert_int_equal(ppmi_murmur3("\x21\x43\x65\x87", 4, 0x5082edee), 0x2362f9de);
    assert_int_equal(ppmi_murmur3("\x21\x43\x65", 3, 0), 0x7e4a8634);
    assert_int_equal(ppmi_murmur3("\x21\x43", 2, 0), 0xa0f7b07a);
    assert_int_equal(ppmi_murmur3("\x21", 1, 0), 0x72661cf4);
    assert_int_equal(ppmi_murmur3("The quick brown fox jumps over the lazy dog", 43, 0),
                     0x2e4ff723);
}

static void no_id_is_a_denormal_an_infinity_or_no_number(void **state)
{
    (void)state;
    uint32_t changed = 0;
    for (uint32_t i = 0; i < 100000; i++) {
        char name[16];
        const int length = snprintf(name, sizeof name, "%u", i);
        const uint32_t id = ppmi_crypto_id(name), hash = ppmi_murmur3(name, (size_t)length, 0);
        const uint32_t exponent = id >> 23 & 255;
        assert_in_range(exponent, 1, 254);
        assert_true(id == hash || (id ^ hash) == UINT32_C(1) << 23);
        changed += id != hash;
    }
    assert_in_range(changed, 500, 1100); /* 2 of 256 exponents */
}

static void a_key_is_seven_digits(void **state)
{
    (void)state;
    char key[8], expected[9];
    ppm_cryptomatte_key("CryptoObject", key);
    snprintf(expected, sizeof expected, "%08x", (unsigned)ppmi_crypto_id("CryptoObject"));
    assert_int_equal(strlen(key), 7);
    assert_memory_equal(key, expected, 7);
}

static void assert_json(const char *name, const char *expected)
{
    char json[128];
    assert_true(ppmi_crypto_json_room(name) <= sizeof json);
    const size_t length = ppmi_crypto_json_write(name, json);
    assert_string_equal(json, expected);
    assert_int_equal(length, strlen(expected));
    assert_true(length < ppmi_crypto_json_room(name));
}

static void names_are_escaped_for_json(void **state)
{
    (void)state;
    assert_json("", "\"\"");
    assert_json("plain name", "\"plain name\"");
    assert_json("a\"b\\c", "\"a\\\"b\\\\c\"");
    assert_json("tab\there\n\x7f", "\"tab\\u0009here\\u000a\\u007f\"");
    assert_json("\x01\x01\x01", "\"\\u0001\\u0001\\u0001\"");
}

static void utf8_stays_and_what_is_not_becomes_latin1(void **state)
{
    (void)state;
    assert_json("m\xc3\xa4"
                "dchen \xe2\x82\xac \xf0\x9f\x8d\xb7",
                "\"m\xc3\xa4"
                "dchen \xe2\x82\xac \xf0\x9f\x8d\xb7\"");
    assert_json("m\xe4", "\"m\\u00e4\"");                     /* Latin-1 */
    assert_json("\xc0\xaf", "\"\\u00c0\\u00af\"");            /* longer than it needs */
    assert_json("\xed\xa0\x80", "\"\\u00ed\\u00a0\\u0080\""); /* a surrogate */
    assert_json("\xf4\x90\x80\x80", "\"\\u00f4\\u0090\\u0080\\u0080\"");
    assert_json("\xe2\x82", "\"\\u00e2\\u0082\""); /* cut off */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ids_are_the_published_ones),
        cmocka_unit_test(ids_are_those_of_published_manifests),
        cmocka_unit_test(ids_and_keys_are_blenders),
        cmocka_unit_test(the_hash_takes_any_length_and_seed),
        cmocka_unit_test(no_id_is_a_denormal_an_infinity_or_no_number),
        cmocka_unit_test(a_key_is_seven_digits),
        cmocka_unit_test(names_are_escaped_for_json),
        cmocka_unit_test(utf8_stays_and_what_is_not_becomes_latin1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
