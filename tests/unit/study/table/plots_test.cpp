// SPDX-License-Identifier: Apache-2.0
#include "tests/study/table/plots.hpp"

#include <filesystem>

#include "common/file/temporary_folder.hpp"
#include "tests/catch.hpp"

namespace sidestep::plots_test {

Plot scenarios() {
  Plot plot{"goals", "scenario", "goals"};
  plot.categories = {"house", "it's an office"};
  plot.lines = {{"errt", {{0, 5, 4, 6}, {1, 7, 7, 7}}}, {"nf1", {{0, 3, 3, 3}, {1, 4, 4, 4}}}};
  return plot;
}

TEST_CASE("categories are compared by bars, not joined by lines") {
  const std::string script = gnuplot_script(scenarios());
  CAPTURE(script);
  CHECK_THAT(script, ContainsSubstring("set xtics ('house' 0, 'it''s an office' 1)"));
  // The two bars of a category stand side by side.
  CHECK_THAT(script, ContainsSubstring("$line0 using ($1+(-0.2000)):2 with boxes") &&
                         ContainsSubstring("$line1 using ($1+(0.2000)):2 with boxes"));
  CHECK_THAT(script, ContainsSubstring("$line0 using ($1+(-0.2000)):3:(0):($4-$3) with vectors nohead"));
  CHECK_THAT(script, !ContainsSubstring("lines ") && !ContainsSubstring("linespoints") &&
                         !ContainsSubstring("$line1 using ($1+(0.2000)):3"));
}

TEST_CASE("quantities are still joined by lines") {
  Plot plot = scenarios();
  plot.categories.clear();
  CHECK_THAT(gnuplot_script(plot), ContainsSubstring("$line0 using 1:2:3:4 with yerrorlines") &&
                                       ContainsSubstring("$line1 using 1:2 with linespoints") &&
                                       !ContainsSubstring("boxes"));
}

TEST_CASE("names of many categories are slanted and have room") {
  Plot plot = scenarios();
  plot.categories = {"an office with a long name", "a warehouse with a long name"};
  CHECK_THAT(gnuplot_script(plot),
             ContainsSubstring("set xtics rotate by -25 (") && ContainsSubstring("set bmargin 11"));
}

TEST_CASE("gnuplot draws bars and lines side by side") {
  const TemporaryFolder folder;
  Plot lines = scenarios();
  lines.categories.clear();
  draw({scenarios(), lines}, folder.file("a.png"));
  CHECK(std::filesystem::file_size(folder.file("a.png")) > 1000);
}

}  // namespace sidestep::plots_test
