# SPDX-License-Identifier: Apache-2.0
# Fast DDS-Gen 2: a header and a source file for each IDL file. The plain types are then made as cheap as structs.
function(sidestep_generate_types library output)
  foreach(name IN LISTS ARGN)
    list(APPEND idl_files ${CMAKE_CURRENT_SOURCE_DIR}/${name}.idl)
    list(APPEND headers ${output}/${name}.hpp ${output}/${name}.h)
    list(APPEND sources ${output}/${name}.cxx)
  endforeach()
  set(room ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  add_custom_command(
    OUTPUT ${headers} ${sources}
    COMMAND ${SIDESTEP_FASTDDSGEN} -cs -replace -d ${output} -t ${output}/tmp -I ${CMAKE_CURRENT_SOURCE_DIR} ${idl_files}
            > ${output}/fastddsgen.log 2>&1 || ${CMAKE_COMMAND} -E cat ${output}/fastddsgen.log
    COMMAND ${CMAKE_COMMAND} -D DIRECTORY=${output} -D "NAMES=${ARGN}" -P ${room}/inline_types.cmake
    DEPENDS ${idl_files} ${room}/inline_types.cmake
    COMMENT "Generating C++ from the IDL"
    VERBATIM)
  add_custom_target(sidestep_generated DEPENDS ${headers})
  add_library(${library} STATIC ${sources} ${headers})
endfunction()
