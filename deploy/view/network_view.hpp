// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

class DdsListener;

/// DDS's information about a domain's processes: their hosts, and mismatched writers and readers. The view
/// joins the domain only at the first call, because an additional participant costs all processes some work.
class NetworkView {
 public:
  explicit NetworkView(const DdsSettings& dds);
  ~NetworkView();
  NetworkView(const NetworkView&) = delete;
  NetworkView& operator=(const NetworkView&) = delete;

  /// {"hosts": [{"host": …, "participants": […]}, …], "mismatches": […]}; complete about a second after the
  /// first call.
  [[nodiscard]] std::string json();

 private:
  DdsSettings dds_;
  std::unique_ptr<DdsListener> listener_;
};

}  // namespace sidestep
