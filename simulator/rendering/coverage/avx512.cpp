// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_INSTRUCTION_SET "avx512"
#define SIDESTEP_KERNELS kAvx512Kernels
#include "simulator/rendering/coverage/coverage_impl.hpp"
