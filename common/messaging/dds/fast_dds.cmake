# SPDX-License-Identifier: Apache-2.0
# Finds Fast DDS 3, or else 2.9. What differs between them is in version_3 and version_2: the same files with the same
# declarations, which all other code includes as "fast_dds/...". Defines
#   sidestep_fast_dds, sidestep_fast_cdr  libraries to link with
#   sidestep_generate_types()             generates the message types
find_package(fastcdr REQUIRED)
find_package(fastdds 3 QUIET)
if(fastdds_FOUND)
  set(version 3)
  set(library fastdds)
  set(found ${fastdds_VERSION})
else()
  find_package(fastrtps 2.9 QUIET)
  if(NOT fastrtps_FOUND)
    message(FATAL_ERROR "Sidestep needs Fast DDS (eProsima), version 3.1 or 2.9 (Debian: libfastdds-dev or libfastrtps-dev). "
                        "If it is installed elsewhere, add its folder to CMAKE_PREFIX_PATH.")
  endif()
  set(version 2)
  set(library fastrtps)
  set(found ${fastrtps_VERSION})
endif()
find_program(FASTDDSGEN fastddsgen REQUIRED)
# For so short a run, Java's better compiler takes more time than it saves.
set(SIDESTEP_FASTDDSGEN ${CMAKE_COMMAND} -E env JDK_JAVA_OPTIONS=-XX:TieredStopAtLevel=1 ${FASTDDSGEN})
message(STATUS "Fast DDS ${found}")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/fast_dds_version.hpp CONTENT
  "#pragma once\ninline constexpr const char* kFastDdsVersion = \"${found}\";\n")

set(room ${CMAKE_CURRENT_LIST_DIR}/version_${version})
include(${room}/generate_types.cmake)
add_library(sidestep_fast_cdr INTERFACE)
target_include_directories(sidestep_fast_cdr INTERFACE ${room})
target_link_libraries(sidestep_fast_cdr INTERFACE fastcdr)
add_library(sidestep_fast_dds INTERFACE)
target_include_directories(sidestep_fast_dds SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/generated)
target_link_libraries(sidestep_fast_dds INTERFACE sidestep_fast_cdr ${library})
