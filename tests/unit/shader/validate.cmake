# Runs spirv-val over FILES.
cmake_minimum_required(VERSION 3.25)
list(LENGTH FILES count)
if(count EQUAL 0)
    message(FATAL_ERROR "no kernels to validate")
endif()
foreach(file IN LISTS FILES)
    execute_process(COMMAND ${SPIRV_VAL} --target-env vulkan1.3 ${file} RESULT_VARIABLE result
        OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        message(SEND_ERROR "${file}: ${output}")
    endif()
endforeach()
message(STATUS "${count} kernels are valid")
