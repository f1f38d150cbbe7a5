# cmake --install: programs, library, headers, pkg-config file, CMake package.
include(CMakePackageConfigHelpers)

install(TARGETS ppm-render ppm-compare ppm-merge RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ppm EXPORT ppm-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET ppm_v3)
    install(TARGETS ppm_v3 LIBRARY NAMELINK_SKIP
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/x86-64-v3)
endif()
install(DIRECTORY include/ppm DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.h)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The prefix in ppm.pc is relative to the file, so that an install tree can be moved.
file(RELATIVE_PATH PPM_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" PPM_PC_PREFIX "${PPM_PC_PREFIX}")
configure_file(cmake/ppm.pc.in ppm.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ppm.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# find_package(ppm) gives ppm::ppm.
set(PPM_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/ppm)
install(EXPORT ppm-targets NAMESPACE ppm:: DESTINATION ${PPM_PACKAGE_DIR})
configure_package_config_file(cmake/ppm-config.cmake.in ppm-config.cmake
    INSTALL_DESTINATION ${PPM_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(ppm-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ppm-config.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/ppm-config-version.cmake DESTINATION ${PPM_PACKAGE_DIR})
