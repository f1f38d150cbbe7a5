# Compiler flags that every target of the project gets: link to ppm::flags.
add_library(ppm_flags INTERFACE)
add_library(ppm::flags ALIAS ppm_flags)

target_compile_options(ppm_flags INTERFACE -Wall -Wextra -Wshadow
    $<$<COMPILE_LANGUAGE:C>:-Wconversion -Wno-sign-conversion -Wstrict-prototypes>)
# errno is never read after a maths call, and no code depends on floating-point traps; both allow
# sqrt and selects to be inlined and vectorised. NaN and infinity keep their meaning.
target_compile_options(ppm_flags INTERFACE -fno-math-errno -fno-trapping-math)
if(PPM_WARNINGS_AS_ERRORS)
    target_compile_options(ppm_flags INTERFACE -Werror)
endif()
if(PPM_SANITIZE)
    target_compile_options(ppm_flags INTERFACE
        -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    target_link_options(ppm_flags INTERFACE -fsanitize=address,undefined)
endif()

# A second libppm for newer processors makes sense only where the loader knows how to choose.
if(PPM_HWCAPS AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    set(PPM_HWCAPS_V3 ON)
else()
    set(PPM_HWCAPS_V3 OFF)
endif()
