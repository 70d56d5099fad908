// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_INSTRUCTION_SET "avx2"
#define SIDESTEP_KERNELS kAvx2Kernels
#include "simulator/rendering/coverage/coverage_impl.hpp"
