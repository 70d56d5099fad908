// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <grp.h>
#include <string>
#include <unistd.h>

#include "tests/forked.hpp"

namespace sidestep {

/// Runs `work` in a process of user nobody, and returns its text. Needs root.
inline std::string as_nobody(const std::function<std::string()>& work) {
  constexpr uid_t kNobody = 65534;
  return forked([&]() -> std::string {
    const bool is_nobody = setgroups(0, nullptr) == 0 && setgid(kNobody) == 0 && setuid(kNobody) == 0;
    return is_nobody ? work() : "user nobody could not be used";
  });
}

}  // namespace sidestep
