// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include "tests/catch.hpp"

/// Ends a test case that needs root. ctest then reports it as skipped, and tests/run counts it.
#define SIDESTEP_NEEDS_ROOT()      \
  do {                             \
    if (geteuid() != 0) {          \
      WARN("skipped: needs root"); \
      return;                      \
    }                              \
  } while (false)
