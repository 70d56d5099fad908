// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/process/command_line.hpp"
#include "vision/images/image_options.hpp"

namespace sidestep {

/// Adds --colours, --cameras and --layout.
void add_image_options(const CliCommand& command, ImageOptions& options);

}  // namespace sidestep
