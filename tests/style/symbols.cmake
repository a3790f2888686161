# What the library brings in hidden stays so: another library's version of it in the same process must neither
# replace it nor be replaced.
# Usage: cmake -DNM=... -DLIBRARY=libheliograph.so -P symbols.cmake
execute_process(COMMAND ${NM} -DC ${LIBRARY} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES "helio::load\\(")
    message(FATAL_ERROR "${LIBRARY} does not export helio::load")
endif()
string(REGEX MATCHALL "[^\n]*tinygltf::[^\n]*" exposed "${symbols}")
if(exposed)
    list(LENGTH exposed count)
    list(GET exposed 0 first)
    message(FATAL_ERROR "${LIBRARY} has ${count} dynamic symbols of tinygltf, such as:\n${first}")
endif()
