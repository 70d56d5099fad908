// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/league/field_geometry.hpp"
#include "common/league/packet_validator.hpp"

#include "league/vision.pb.h"

namespace sidestep::league {

/// Conversions between the wire format (whole or floating-point millimetres) and metres.
void write(const Geometry& geometry, wire::vision::Geometry& to);
Geometry read(const wire::vision::Geometry& from, PacketValidator& validator);

}  // namespace sidestep::league
