// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/library_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/log/log.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/time/rate_limit.hpp"

namespace sidestep {
namespace {

using eprosima::fastdds::dds::Log;

constexpr std::size_t kKeptErrors = 4;

std::mutex errors_mutex;
std::vector<std::string> errors;  ///< the first errors since the last call of take_library_errors()

void keep_error(const Log::Entry& entry) {
  const std::lock_guard lock(errors_mutex);
  if (errors.size() < kKeptErrors) errors.push_back(entry.message);
}

/// Fast DDS calls this from a single thread.
class LibraryLog : public eprosima::fastdds::dds::LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    if (entry.kind == Log::Kind::Error) keep_error(entry);
    const std::string category = entry.context.category == nullptr ? "" : entry.context.category;
    const std::string function = entry.context.function == nullptr ? "" : entry.context.function;
    Source& source = sources_[category + " " + function];
    if (!source.limit.admit(EventLoop::now())) {
      ++source.left_out;
      return;
    }
    const std::string left_out =
        source.left_out == 0 ? "" : fmt::format(" ({} similar messages left out)", source.left_out);
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

std::string take_library_errors() {
  Log::Flush();
  const std::lock_guard lock(errors_mutex);
  return fmt::format("{}", fmt::join(std::exchange(errors, {}), "; "));
}

}  // namespace sidestep
