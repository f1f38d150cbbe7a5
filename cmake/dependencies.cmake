# Third parties. Each is seen by one folder only (CONTRIBUTING.md).
find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS C)

# For packages that call only the same minor version compatible, and so refuse a newer one
# (tinygltf: Debian 12 has 2.7, Debian 13 2.9; meshoptimizer: 0.18 and 0.22).
macro(ppm_find_at_least name version)
    find_package(${name} REQUIRED CONFIG)
    if(${name}_VERSION VERSION_LESS ${version})
        message(FATAL_ERROR "${name} ${${name}_VERSION} is too old: ${version} is needed")
    endif()
endmacro()

# Embree 4 where it is to be had, else 3.13.
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
    find_package(embree 3.13 REQUIRED CONFIG)
endif()

find_package(OpenImageIO 2.4 REQUIRED CONFIG)
# Debian 12's target names OpenCV's include folder, which is there only with OpenCV's own package and
# which nothing here needs.
get_target_property(PPM_OIIO_INCLUDES OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
foreach(folder ${PPM_OIIO_INCLUDES})
    if(NOT folder MATCHES "^[$]<" AND NOT EXISTS ${folder})
        list(REMOVE_ITEM PPM_OIIO_INCLUDES ${folder})
    endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${PPM_OIIO_INCLUDES}")

find_package(OpenColorIO 2.1 QUIET CONFIG)
if(TARGET OpenColorIO::OpenColorIO)
    set(PPM_OCIO_TARGET OpenColorIO::OpenColorIO)
else()
    # Debian 12 has OpenColorIO's pkg-config file only.
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(OCIO REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)
    set(PPM_OCIO_TARGET PkgConfig::OCIO)
endif()

ppm_find_at_least(TinyGLTF 2.7)
if(TARGET TinyGLTF::TinyGLTF)
    set(PPM_TINYGLTF_TARGET TinyGLTF::TinyGLTF) # Debian: a shared library
else()
    set(PPM_TINYGLTF_TARGET tinygltf::tinygltf) # upstream
endif()

find_package(tinyobjloader REQUIRED CONFIG)
set(PPM_TINYOBJ_TARGET tinyobjloader::tinyobjloader) # single precision; a shared library on Debian

# Setup files, statistics, lists.
find_package(PkgConfig REQUIRED)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)

# Compressed geometry of glTF. Draco may be left out.
ppm_find_at_least(meshoptimizer 0.18)
if(PPM_WITH_DRACO)
    find_package(draco QUIET CONFIG)
    if(NOT TARGET draco::draco)
        message(FATAL_ERROR "Draco 1.5 is not here (Debian: libdraco-dev). Install it, or build "
            "without KHR_draco_mesh_compression: -DPPM_WITH_DRACO=OFF")
    endif()
    # Debian's Draco has a tinygltf of its own inside, of another version, and shows its symbols: the
    # loader takes those of the library that is linked first, which must be tinygltf. The static one
    # is no way out: libtinygltf.so has an open symbol that makes the linker take Draco's copy.
    set(PPM_DRACO_TARGET ${PPM_TINYGLTF_TARGET} draco::draco)
    set(PPM_DRACO_SOURCE gltf_draco_shim.cpp)
else()
    set(PPM_DRACO_TARGET "")
    set(PPM_DRACO_SOURCE gltf_draco_none.c)
endif()

# Packed pictures in KTX files. Without a library, such pictures are left out with a message.
add_library(ppm_unpack INTERFACE)
add_library(ppm::unpack ALIAS ppm_unpack)
find_package(ZLIB QUIET)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_check_modules(ZSTD QUIET IMPORTED_TARGET libzstd>=1.4)
endif()
foreach(library ZLIB::ZLIB PkgConfig::ZSTD)
    string(REGEX REPLACE ".*::" "" name ${library})
    if(TARGET ${library})
        target_link_libraries(ppm_unpack INTERFACE ${library})
        target_compile_definitions(ppm_unpack INTERFACE PPM_HAS_${name}=1)
    else()
        message(STATUS "No ${name}: KTX2 pictures packed by it will be left out")
        target_compile_definitions(ppm_unpack INTERFACE PPM_HAS_${name}=0)
    endif()
endforeach()
find_package(astcenc QUIET CONFIG)
if(TARGET astcenc::astcenc)
    target_link_libraries(ppm_unpack INTERFACE astcenc::astcenc)
    target_compile_definitions(ppm_unpack INTERFACE PPM_HAS_ASTC=1)
else()
    message(STATUS "No astcenc: KTX2 pictures in ASTC will be left out")
    target_compile_definitions(ppm_unpack INTERFACE PPM_HAS_ASTC=0)
endif()
