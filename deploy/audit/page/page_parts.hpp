// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sidestep {

// report.css and report.js, which are compiled into the program.
extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace sidestep
