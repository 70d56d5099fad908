// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_LEVEL "baseline"
#define SIDESTEP_KERNELS kBaselineKernels
#include "simulator/rendering/counting/code.hpp"
