// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace sidestep {

/// Slot of a delivered message in which the readers of this process cache the decoded message, so that only
/// the first reader decodes it. The slot is initially empty and has the message's lifetime.
class MessageAttachment {
 public:
  /// The value stored by set(); null if the slot is empty or holds another type.
  template <typename Value>
  [[nodiscard]] std::shared_ptr<Value> get() const {
    return type_ == &kType<Value> ? std::static_pointer_cast<Value>(value_) : nullptr;
  }
  template <typename Value>
  void set(std::shared_ptr<Value> value) {
    value_ = std::move(value);
    type_ = &kType<Value>;
  }

 private:
  // The address of this variable identifies the type.
  template <typename Value>
  static constexpr char kType = 0;

  std::shared_ptr<void> value_;
  const char* type_ = nullptr;
};

}  // namespace sidestep
