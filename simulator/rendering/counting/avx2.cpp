// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_LEVEL "avx2"
#define SIDESTEP_KERNELS kAvx2Kernels
#include "simulator/rendering/counting/code.hpp"
