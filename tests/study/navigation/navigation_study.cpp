// SPDX-License-Identifier: Apache-2.0
#include "tests/study/navigation/navigation_study.hpp"

#include "tests/study/navigation/cost_effects.hpp"
#include "tests/study/navigation/kernel_errors.hpp"
#include "tests/study/navigation/replanning_effects.hpp"

namespace sidestep {

int study_navigation(const StudyOptions& options) {
  require_study_output(options);
  const bool is_quick = options.is_quick;
  const auto write = [&](const StudyTable& table) {
    write_study_table(table, "navigation", options);
    fmt::print("{}\n", markdown_of(table));
  };
  write(errors_by_direction(is_quick ? 81 : 401));
  write(errors_among_obstacles(is_quick ? 80 : 500, is_quick ? 1 : 4, options.seed));
  write(replanning_effects(is_quick ? 120 : 500, is_quick ? 3 : 40, options.seed));
  write(cost_effects());
  return 0;
}

}  // namespace sidestep
