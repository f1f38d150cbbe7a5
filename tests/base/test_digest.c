/* The digest is the published one, however its bytes come. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/digest.h"

static const char fox[] = "The quick brown fox jumps over the lazy dog";

static void assert_digest(const ppmi_digest *digest, const char *expected)
{
    char text[PPMI_DIGEST_TEXT_SIZE];
    ppmi_digest_write(digest, text);
    assert_string_equal(text, expected);
}

static void known_texts_have_their_published_digests(void **state)
{
    (void)state;
    ppmi_digest nothing = {0}, hello = {0}, sentence = {0};
    assert_digest(&nothing, "00000000000000000000000000000000");
    ppmi_digest_add(&hello, "hello", 5);
    assert_digest(&hello, "cbd8a7b341bd9b025b1e906a48ae1d19");
    ppmi_digest_add(&sentence, fox, strlen(fox));
    assert_digest(&sentence, "e34bbc7bbc071b6c7a433ca9c49a9347");
}

static void pieces_count_as_one(void **state)
{
    (void)state;
    const size_t length = strlen(fox);
    for (size_t first = 0; first <= length; first++) {
        for (size_t second = first; second <= length; second++) {
            ppmi_digest digest = {0};
            ppmi_digest_add(&digest, fox, first);
            ppmi_digest_add(&digest, fox + first, second - first);
            ppmi_digest_add(&digest, fox + second, length - second);
            assert_digest(&digest, "e34bbc7bbc071b6c7a433ca9c49a9347");
        }
    }
}

static void the_ends_of_texts_count(void **state)
{
    (void)state;
    char a[PPMI_DIGEST_TEXT_SIZE], b[PPMI_DIGEST_TEXT_SIZE];
    ppmi_digest one = {0}, other = {0};
    ppmi_digest_add_text(&one, "ab");
    ppmi_digest_add_text(&one, "c");
    ppmi_digest_add_text(&other, "a");
    ppmi_digest_add_text(&other, "bc");
    ppmi_digest_write(&one, a);
    ppmi_digest_write(&other, b);
    assert_string_not_equal(a, b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_texts_have_their_published_digests),
        cmocka_unit_test(pieces_count_as_one),
        cmocka_unit_test(the_ends_of_texts_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
