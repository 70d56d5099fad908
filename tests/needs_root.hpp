// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <catch2/catch.hpp>
#include <unistd.h>

/// Ends a test case that cannot be made without root; ctest then says that it was skipped, and tests/run how
/// many were.
#define SIDESTEP_NEEDS_ROOT()      \
  do {                             \
    if (geteuid() != 0) {          \
      WARN("skipped: needs root"); \
      return;                      \
    }                              \
  } while (false)
