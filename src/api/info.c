/* Version and build. */
#include <pthread.h>
#include <stdio.h>

#include "accel/accel.h"
#include "color/color.h"
#include "imageio/imageio.h"
#include "ppm/context.h"

#define STRINGIZE_(x) #x
#define STRINGIZE(x) STRINGIZE_(x)

const char *ppm_version(void)
{
    return STRINGIZE(PPM_VERSION_MAJOR) "." STRINGIZE(PPM_VERSION_MINOR) "." STRINGIZE(
        PPM_VERSION_PATCH);
}

#if defined(__AVX2__) && defined(__FMA__)
#define INSTRUCTION_SET "x86-64-v3 (AVX2)"
#elif defined(__x86_64__)
#define INSTRUCTION_SET "x86-64 (SSE2)"
#else
#define INSTRUCTION_SET "generic"
#endif

static char build_info[256];

static void write_build_info(void)
{
    snprintf(build_info, sizeof build_info, "libppm %s, %s, %s, %s, built for %s", ppm_version(),
             ppmi_accel_version(), ppmi_imageio_version(), ppmi_color_version(), INSTRUCTION_SET);
}

const char *ppm_build_info(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, write_build_info);
    return build_info;
}
