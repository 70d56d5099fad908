// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// The JSON schema of scenario files, by which editors complete keys and mark mistakes. Keys and ranges are
/// those that the loader reads, descriptions those of deploy/scenarios/README.md. The schema accepts every
/// file that the loader accepts. It does not know conditions between keys, such as the safety budget.
[[nodiscard]] std::string scenario_schema();

/// The path of the schema's file: beside the installed scenarios, or in the tree in which this program was
/// built. Empty if there is no such file.
[[nodiscard]] std::string scenario_schema_path();

}  // namespace sidestep
