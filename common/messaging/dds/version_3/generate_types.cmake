# SPDX-License-Identifier: Apache-2.0
# Fast DDS-Gen 4: headers for each IDL file, and definitions (.ipp) that one source file includes.
function(sidestep_generate_types library output)
  set(includes "")
  foreach(name IN LISTS ARGN)
    list(APPEND idl_files ${CMAKE_CURRENT_SOURCE_DIR}/${name}.idl)
    list(APPEND headers ${output}/${name}.hpp ${output}/${name}CdrAux.hpp)
    list(APPEND definitions ${output}/${name}CdrAux.ipp)
    string(APPEND includes "#include \"idl/${name}CdrAux.ipp\"\n")
  endforeach()
  set(source ${output}/types.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "${includes}" @ONLY)
  add_custom_command(
    OUTPUT ${headers} ${definitions}
    COMMAND ${SIDESTEP_FASTDDSGEN} -cs -replace -no-typeobjectsupport -d ${output} -t ${output}/tmp
            -I ${CMAKE_CURRENT_SOURCE_DIR} ${idl_files}
            > ${output}/fastddsgen.log 2>&1 || ${CMAKE_COMMAND} -E cat ${output}/fastddsgen.log
    DEPENDS ${idl_files}
    COMMENT "Generating C++ from the IDL"
    VERBATIM)
  add_custom_target(sidestep_generated DEPENDS ${headers})
  add_library(${library} STATIC ${source} ${headers} ${definitions})
endfunction()
