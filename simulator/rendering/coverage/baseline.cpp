// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_INSTRUCTION_SET "baseline"
#define SIDESTEP_KERNELS kBaselineKernels
#include "simulator/rendering/coverage/coverage_impl.hpp"
