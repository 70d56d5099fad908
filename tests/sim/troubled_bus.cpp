// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/troubled_bus.hpp"

#include <utility>

namespace sidestep {
namespace {

class MutableWriter : public RawWriter {
 public:
  MutableWriter(std::unique_ptr<RawWriter> inner, const bool& is_mute)
      : inner_(std::move(inner)), is_mute_(is_mute) {}
  void write(const void* message) override {
    if (!is_mute_) inner_->write(message);
  }

 private:
  std::unique_ptr<RawWriter> inner_;
  const bool& is_mute_;
};

}  // namespace

void TroubledBus::run(std::function<void()> work) {
  if (is_stopped_) {
    waiting_.push_back(std::move(work));
  } else {
    work();
  }
}

void TroubledBus::at(Time when, std::function<void()> callback) {
  SimBus::at(when - clock_ahead_, [this, callback = std::move(callback)] { run(callback); });
}

void TroubledBus::go_on() {
  is_stopped_ = false;
  while (!waiting_.empty()) {
    const auto work = std::move(waiting_.front());
    waiting_.pop_front();
    work();
  }
}

std::unique_ptr<RawWriter> TroubledBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  return std::make_unique<MutableWriter>(SimBus::make_writer(topic, channel), is_mute_);
}

void TroubledBus::make_reader(const TopicInfo& topic, const std::string& channel,
                              std::function<void(const void*)> callback) {
  const auto hear = [this, topic_name = std::string(topic.name), copy = topic.type.copy,
                     callback = std::move(callback)](const void* message) {
    if (is_deaf_ || deaf_to_.count(topic_name)) return;
    if (!is_stopped_) return callback(message);
    waiting_.push_back([callback, kept = copy(message)] { callback(kept.get()); });
  };
  SimBus::make_reader(topic, channel, hear);
}

}  // namespace sidestep
