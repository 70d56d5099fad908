// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/keys/identity.hpp"
#include "common/messaging/bus.hpp"

namespace sidestep {

/// Ports of higher domains would exceed 65535 (RTPS 2.2, 9.6.1.1). In this domain, 62 processes fit on a
/// machine.
inline constexpr int kMaxDomain = 232;

struct DdsSettings {
  int domain = 0;                        ///< 0 .. kMaxDomain
  std::string interface = "127.0.0.1";   ///< address of the only interface to use; "all": all interfaces
  std::string participant = "sidestep";  ///< name announced to the domain
  bool faults = false;                   ///< arriving messages may be impaired, see DdsBus::impair()
  bool is_operator = false;              ///< messages from this participant are never impaired
  /// Addresses of all hosts that run processes, including this one. Empty: processes find each other by
  /// multicast.
  std::vector<std::string> peers{};
  /// Folder with the keys of one identity, or a folder made by `sidestep keys init`. Empty: no keys, so any
  /// machine on the network can command the robots.
  std::string keys{};
  bool insecure = false;  ///< allows running without keys on networks that other machines can reach
  /// The identity whose keys are used if the folder contains several.
  Identity identity{Role::kViewer};
  /// Whether arriving states are queued until they are read, for readers that must see every state. If false,
  /// a newer state replaces an unread one, for readers that only need the latest state.
  bool keeps_all = false;
  bool is_local_bus = false;  ///< created by DdsBus::local_bus(): no warning about missing keys
};

/// The version of Fast DDS that this program was built with, e.g. "3.1.2".
std::string fast_dds_version();

struct LinkQuality;

/// A bus over Fast DDS and UDPv4. A second participant per process carries images by shared memory. All
/// callbacks are made by the thread that calls run(). Throws std::runtime_error with the reason if a
/// participant or an endpoint cannot be created. Throws std::invalid_argument if its keys are wrong, if
/// required keys are missing (see DdsSettings), or if they do not permit an operation.
class DdsBus : public Bus {
 public:
  explicit DdsBus(const DdsSettings& settings);
  ~DdsBus() override;
  DdsBus(const DdsBus&) = delete;
  DdsBus& operator=(const DdsBus&) = delete;

  Time now() const override;
  /// See the functions of the same names in EventLoop. Precondition of adopt_host_clock(): there is no bus.
  static Time clock();
  static Duration host_clock_ahead();
  static void adopt_host_clock();
  void at(Time when, std::function<void()> callback) override;

  /// Calls back whenever the descriptor, for example a socket, is readable. It must stay open until the bus
  /// has stopped.
  void watch(int descriptor, std::function<void()> readable);

  /// Calls back soon, in the thread that runs the bus, in the order of the calls to post(). Thread-safe.
  void post(std::function<void()> callback);

  /// Runs and makes callbacks until stop().
  void run();
  /// Runs and makes callbacks until `when` or stop(). For tests and tools that act between callbacks.
  void run_until(Time when);
  /// Makes the current and all later calls of run() and run_until() return soon. Thread-safe and
  /// async-signal-safe.
  void stop();

  /// Creates a bus without keys in another domain, over the loopback interface, for third-party programs on
  /// this machine. Its callbacks are made by the thread that runs this bus, which must outlive the last of
  /// them. Throws as the constructor does, and std::invalid_argument if the domain is this bus's own.
  std::unique_ptr<DdsBus> local_bus(int domain) const;

  /// The addresses on which this participant listens for messages, for the log. Empty before the first
  /// subscription.
  std::string locators() const;

  /// From now on, impairs all arriving messages except those of operators. Precondition: DdsSettings::faults.
  void impair(const LinkQuality& quality, std::uint64_t seed);

  bool has_keys() const;
  /// Whether this process has no keys, but a participant of the domain has, which therefore ignores it. This
  /// is also logged.
  bool meets_keys() const;
  bool may_write(const TopicInfo& topic, std::uint32_t robot) const override;
  bool may_read(const TopicInfo& topic, std::uint32_t robot) const override;

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo& topic, const std::string& channel) override;
  void make_reader(const TopicInfo& topic, const std::string& channel,
                   std::function<void(const void*)> callback) override;
  void add_drops(DropCounters& drops) const override;

 private:
  struct Impl;
  explicit DdsBus(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
