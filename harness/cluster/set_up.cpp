#include "harness/cluster/set_up.hpp"

#include <cstdio>

#include <fmt/format.h>

#include "harness/cluster/studio.hpp"

namespace beambench::cluster {
namespace {

void send_all_home(Transport& transport) {
  for (ProcessId process = kProducer + 1; process < transport.processes(); ++process) {
    transport.send(process, Tag::kEnd, {});
  }
  transport.flush();
}

void wait_for_end(Transport& transport) {
  while (true) {
    const auto message = transport.wait(Transport::kForever);
    if (message && message->tag == Tag::kEnd) return;
  }
}

}  // namespace

void set_up_to_lead(Transport& transport,
                    const std::function<void(std::vector<std::string>& warnings)>& set_up) {
  std::vector<std::string> warnings;
  try {
    set_up(warnings);
  } catch (...) {
    send_all_home(transport);
    throw;
  }
  for (const std::string& warning : warnings) {
    fmt::print(stderr, "beambench-cluster: {}\n", warning);
  }
}

void excuse(Transport& transport, const std::string& problem) {
  Introduction introduction;
  introduction.host = host_name();
  introduction.problem = problem;
  transport.send(kProducer, Tag::kReady, write_introduction(introduction));
  wait_for_end(transport);
}

}  // namespace beambench::cluster
