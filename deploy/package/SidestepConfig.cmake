# SPDX-License-Identifier: Apache-2.0
# Defines Sidestep::client, the library of <sidestep/client.hpp>.
include(${CMAKE_CURRENT_LIST_DIR}/SidestepTargets.cmake)
