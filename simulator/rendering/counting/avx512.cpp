// SPDX-License-Identifier: Apache-2.0
#define SIDESTEP_LEVEL "avx512"
#define SIDESTEP_KERNELS kAvx512Kernels
#include "simulator/rendering/counting/code.hpp"
