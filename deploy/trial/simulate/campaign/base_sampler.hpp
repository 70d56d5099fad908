// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "common/random/rng.hpp"
#include "deploy/trial/simulate/system/driven_bases.hpp"

namespace sidestep {

/// Samples the properties of a base: like those of simulators in use and of robots, see
/// deploy/trial/conformance/README.md.
BaseSettings sample_base(Rng& rng, Duration min_latency, Duration max_latency);

/// Samples the floor of the scenes in which robots are driven bases; nullopt in scenes where they have
/// firmware. Besides what sample_base() samples, the simulation may be slower than real time or advance in
/// steps, and its cameras may disagree.
std::optional<DrivenBaseSettings> sample_driven_bases(Rng& rng);

/// Sets the scenario's budget and limits for the bases, by the rules of deploy/trial/conformance/README.md.
void prepare_for(Scenario& scenario, const DrivenBaseSettings& bases);

/// What is unusual about the bases, as in Trial::fault_kinds().
std::set<std::string> fault_kinds(const DrivenBaseSettings& bases);

/// A description of the bases in one line.
std::string to_text(const DrivenBaseSettings& bases);

}  // namespace sidestep
