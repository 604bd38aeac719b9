#pragma once
// CPU time of messages, on either side.

#include <functional>
#include <utility>

#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// Lets seconds of the (simulated) CPU pass.
using Spend = std::function<void(double seconds)>;

/// CPU seconds for messages, in addition to the network's time.
struct MessageCost {
  double message_seconds;  ///< for each, sent or received
  double byte_seconds;     ///< for each byte of it
  double look_seconds;     ///< to poll when there is none
};

/// A transport that charges CPU time for messages.
class ChargedTransport : public Transport {
 public:
  ChargedTransport(Transport& carrier, const MessageCost& cost, Spend spend)
      : carrier_(&carrier), cost_(cost), spend_(std::move(spend)) {}

  ProcessId self() const override { return carrier_->self(); }
  int processes() const override { return carrier_->processes(); }
  double seconds() const override { return carrier_->seconds(); }

  void send(ProcessId to, Tag tag, Bytes bytes) override {
    charge(bytes);
    carrier_->send(to, tag, std::move(bytes));
  }
  void flush() override { carrier_->flush(); }
  std::optional<Message> poll() override {
    auto message = carrier_->poll();
    if (message) {
      charge(message->bytes);
    } else {
      spend_(cost_.look_seconds);
    }
    return message;
  }
  std::optional<Message> wait(double seconds) override {
    auto message = carrier_->wait(seconds);
    if (message) charge(message->bytes);
    return message;
  }
  void broadcast(Bytes& bytes) override {
    charge(bytes);
    carrier_->broadcast(bytes);
  }

 private:
  void charge(const Bytes& bytes) {
    spend_(cost_.message_seconds + cost_.byte_seconds * static_cast<double>(bytes.size()));
  }

  Transport* carrier_;
  MessageCost cost_;
  Spend spend_;
};

}  // namespace beambench::cluster
