// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/messaging/dds/bus.hpp"
#include "deploy/inspect/topic/message_printer.hpp"

namespace sidestep {

struct TopicOptions {
  DdsSettings dds;
  std::string topic;         ///< the DDS topic name, for example feedback/3
  double seconds = 0;        ///< 0: until Ctrl-C
  double discovery_s = 1.5;  ///< participants announce themselves once per second
  MessagePrinterSettings printer;
  std::string recording_file;  ///< empty: inspects a running system
  std::string idl_file;        ///< IDL of the topic's type, if it is not one of ours
  std::string type;            ///< name of the type; empty: as announced by the topic's writer
  std::string message;         ///< JSON to publish
  double rate_hz = 1;          ///< rate if several messages are published
};

/// The actions of `sidestep topic`. Each prints on stdout, stops on SIGINT and SIGTERM, returns the exit
/// code, passes on exceptions of DdsBus and PlaybackBus, and throws std::invalid_argument for a filter that
/// fits no message.
int list_topics(const TopicOptions& options);
int show_topic(const TopicOptions& options);
int measure_rate(const TopicOptions& options);
int measure_bandwidth(const TopicOptions& options);
int measure_delay(const TopicOptions& options);
int echo_topic(const TopicOptions& options);
int publish_topic(const TopicOptions& options);

}  // namespace sidestep
