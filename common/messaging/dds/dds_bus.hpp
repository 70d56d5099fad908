// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/messaging/bus.hpp"

namespace sidestep {

struct DdsSettings {
  int domain = 0;                        ///< 0 .. 99
  std::string interface = "127.0.0.1";   ///< address of the one interface to use; "all": every interface
  std::string participant = "sidestep";  ///< name that listeners see
  bool faults = false;                   ///< what arrives can be disturbed, see DdsBus::impair
  bool is_operator = false;              ///< no fault touches what this participant sends
};

struct LinkQuality;

/// The bus over Fast DDS (dds.md): one participant, UDPv4 only. Samples are taken and timers fire in the
/// thread that calls run(). Throws std::runtime_error when the participant or an endpoint cannot be created,
/// saying why.
class DdsBus : public Bus {
 public:
  explicit DdsBus(const DdsSettings& settings);
  ~DdsBus() override;
  DdsBus(const DdsBus&) = delete;
  DdsBus& operator=(const DdsBus&) = delete;

  Time now() const override;
  void at(Time when, std::function<void()> callback) override;

  /// Calls back whenever the descriptor, a socket say, can be read; it may be closed when the bus has
  /// stopped.
  void watch(int descriptor, std::function<void()> readable);

  /// Calls back until stop().
  void run();
  /// Calls back until then, or stop(); for tests and tools that look between callbacks.
  void run_until(Time when);
  /// Makes run() and run_until() return soon, now and ever after. From any thread, and from a signal handler.
  void stop();

  /// The addresses this participant really listens on for messages, for the log; empty before it subscribes.
  std::string locators() const;
  /// Messages so far whose payload was not one of the topic's type and was dropped.
  std::uint64_t refused() const;

  /// From now on this happens to all messages that arrive, except an operator's. Precondition:
  /// DdsSettings::faults.
  void impair(const LinkQuality& quality, std::uint64_t seed);

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
