// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace sidestep {

using Vec3 = Eigen::Vector3d;

}  // namespace sidestep
