# The shared library exports ppm_* and nothing else.
execute_process(COMMAND ${NM} -D --defined-only --format=posix ${LIBRARY}
    OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " [^\n]*" "" names "${names}")
string(REGEX REPLACE "\n" ";" names "${names}")
list(REMOVE_ITEM names "")
list(FIND names ppm_render_advance found)
if(found EQUAL -1)
    message(FATAL_ERROR "ppm_render_advance is not exported: ${names}")
endif()
list(FILTER names EXCLUDE REGEX "^ppm_")
if(names)
    message(FATAL_ERROR "exported, but not ppm_*: ${names}")
endif()
