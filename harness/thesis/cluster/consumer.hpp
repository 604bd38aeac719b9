#pragma once
// A process that performs the producer's tasks.

#include <span>

#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Encodes a consumer's final report: its tasks, times and counts.
Bytes write_report(const ProcessReport& report);
/// Reads the report into the producer's report on that process. Throws ProtocolError for other
/// bytes.
void read_report(std::span<const std::byte> bytes, ProcessReport& report);

/// Runs a consumer (section 6.2): sends `ready_report`, then receives parcels, performs their tasks
/// and sends the results until the end message arrives. During a long task it sends a heartbeat
/// every `heartbeat_interval` seconds.
void consume(Transport& transport, TaskWorker& worker, double heartbeat_interval,
             Bytes ready_report);

}  // namespace beambench::cluster
