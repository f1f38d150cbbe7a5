# Installs, moves the install tree, and builds a small host program out of it: by find_package and
# by pkg-config. Runs both, and the installed programs.
function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE output
        OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${WORK}/moved)
set(prefix ${WORK}/moved)

run(${prefix}/bin/ppm-compare --version)
run(${prefix}/bin/ppm-merge --version)
run(${prefix}/bin/ppm-render --version)
set(version "${output}")

run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/cmake -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_C_COMPILER=${C_COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/cmake)
run(${WORK}/cmake/consumer)
if(NOT version MATCHES "ppm-render ${output}\n")
    message(FATAL_ERROR "find_package: the library says '${output}', the program '${version}'")
endif()

set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
run(${PKG_CONFIG} --cflags --libs ppm)
separate_arguments(flags UNIX_COMMAND "${output}")
run(${C_COMPILER} -std=c17 ${CONSUMER}/consumer.c -o ${WORK}/consumer ${flags}
    -Wl,-rpath,${prefix}/${LIBDIR})
run(${WORK}/consumer)
if(NOT version MATCHES "ppm-render ${output}\n")
    message(FATAL_ERROR "pkg-config: the library says '${output}', the program '${version}'")
endif()
