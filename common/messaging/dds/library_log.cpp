// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/library_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <fmt/core.h>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "common/log/log.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {
namespace {

using eprosima::fastdds::dds::Log;

/// Fast DDS calls it by one thread.
class LibraryLog : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    const std::string category = entry.context.category == nullptr ? "" : entry.context.category;
    const std::string function = entry.context.function == nullptr ? "" : entry.context.function;
    Source& source = sources_[category + " " + function];
    if (!source.limit.admit(EventLoop::now())) {
      ++source.left_out;
      return;
    }
    const std::string left_out =
        source.left_out == 0 ? "" : fmt::format(" ({} like it left out)", source.left_out);
    source.left_out = 0;
    log(entry.kind == Log::Kind::Error ? LogLevel::kError : LogLevel::kWarning,
        fmt::format("Fast DDS, {}: {}{}", category, entry.message, left_out));
  }

 private:
  struct Source {
    RateLimit limit{4, std::chrono::seconds(20)};
    std::uint64_t left_out = 0;
  };
  std::map<std::string, Source> sources_;
};

}  // namespace

void log_library() {
  static std::once_flag once;
  std::call_once(once, [] {
    Log::ClearConsumers();
    Log::RegisterConsumer(std::make_unique<LibraryLog>());
  });
}

}  // namespace sidestep
