// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/faulty_bus.hpp"

#include <utility>

namespace sidestep {
namespace {

class BlockableWriter : public RawWriter {
 public:
  BlockableWriter(std::unique_ptr<RawWriter> inner, const bool& is_blocked)
      : inner_(std::move(inner)), is_blocked_(is_blocked) {}
  void write(const void* message) override {
    if (!is_blocked_) inner_->write(message);
  }

 private:
  std::unique_ptr<RawWriter> inner_;
  const bool& is_blocked_;
};

}  // namespace

void FaultyBus::run(std::function<void()> work) {
  if (is_stopped_) {
    queue_.push_back(std::move(work));
  } else {
    work();
  }
}

void FaultyBus::at(Time when, std::function<void()> callback) {
  SimBus::at(when - clock_offset_, [this, callback = std::move(callback)] { run(callback); });
}

void FaultyBus::resume() {
  is_stopped_ = false;
  while (!queue_.empty()) {
    const auto work = std::move(queue_.front());
    queue_.pop_front();
    work();
  }
}

std::unique_ptr<RawWriter> FaultyBus::make_writer(const TopicInfo& topic, const std::string& channel) {
  return std::make_unique<BlockableWriter>(SimBus::make_writer(topic, channel), blocks_outgoing_);
}

void FaultyBus::make_reader(const TopicInfo& topic, const std::string& channel,
                            std::function<void(const void*)> callback) {
  const auto receive = [this, topic_name = std::string(topic.name), copy = topic.type.copy,
                        callback = std::move(callback)](const void* message) {
    if (blocks_incoming_ || blocked_topics_.count(topic_name)) return;
    if (!is_stopped_) return callback(message);
    queue_.push_back([callback, kept = copy(message)] { callback(kept.get()); });
  };
  SimBus::make_reader(topic, channel, receive);
}

}  // namespace sidestep
