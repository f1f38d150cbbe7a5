# libppm: all modules in one shared library that exports ppm_* only.
#
# With PPM_HWCAPS the modules' C sources are compiled a second time for x86-64-v3 (AVX2, FMA) into a
# library of the same name in lib/glibc-hwcaps/x86-64-v3/. The loader of glibc 2.33 and later looks
# there first on a processor that has these instructions (docs/building.md).

# ppm_libppm(TARGET OUTPUT_DIRECTORY OBJECT...)
function(ppm_libppm target directory)
    add_library(${target} SHARED ${ARGN})
    target_include_directories(${target} INTERFACE
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(${target} PRIVATE ppm::flags ${PPM_OCIO_TARGET} OpenImageIO::OpenImageIO
        ${PPM_TINYGLTF_TARGET} meshoptimizer::meshoptimizer ${PPM_DRACO_TARGET} ppm::unpack ${PPM_TINYOBJ_TARGET}
        PkgConfig::JANSSON embree OpenMP::OpenMP_C Threads::Threads m)
    # Hidden visibility is not enough: libstdc++ marks its own templates as visible.
    target_link_options(${target} PRIVATE
        LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/libppm.map)
    set_target_properties(${target} PROPERTIES
        OUTPUT_NAME ppm VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
        LINKER_LANGUAGE CXX LIBRARY_OUTPUT_DIRECTORY ${directory}
        LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/libppm.map)
endfunction()

get_property(PPM_MODULES GLOBAL PROPERTY PPM_MODULES)
set(PPM_OBJECTS ${PPM_MODULES})
list(TRANSFORM PPM_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
ppm_libppm(ppm ${CMAKE_BINARY_DIR}/lib ${PPM_OBJECTS})

if(PPM_HWCAPS_V3)
    get_property(PPM_V3_MODULES GLOBAL PROPERTY PPM_V3_MODULES)
    set(PPM_V3_OBJECTS ${PPM_V3_MODULES})
    list(TRANSFORM PPM_V3_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
    # The C++ shims spend their time in other libraries: their objects serve both.
    list(TRANSFORM PPM_OBJECTS REPLACE "(.+)" "$<FILTER:\\1,INCLUDE,[.]cpp[.]o$>")
    ppm_libppm(ppm_v3 ${CMAKE_BINARY_DIR}/lib/glibc-hwcaps/x86-64-v3
        ${PPM_V3_OBJECTS} ${PPM_OBJECTS})
endif()
