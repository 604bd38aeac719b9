#pragma once
// The computing parts of a run: sources of tasks, workers, sinks of results.

#include <functional>
#include <span>

#include "harness/cluster/messages.hpp"

namespace beambench::cluster {

/// Makes the producer's tasks.
class TaskSource {
 public:
  TaskSource() = default;
  TaskSource(const TaskSource&) = delete;
  TaskSource& operator=(const TaskSource&) = delete;
  virtual ~TaskSource() = default;

  /// Appends the next task to a message; false when there are no more.
  virtual bool next(Bytes& task) = 0;
};

/// Called from time to time within a long task.
using Heartbeat = std::function<void()>;

/// Performs tasks.
class TaskWorker {
 public:
  TaskWorker() = default;
  TaskWorker(const TaskWorker&) = delete;
  TaskWorker& operator=(const TaskWorker&) = delete;
  virtual ~TaskWorker() = default;

  /// Performs a task and appends its result to a message. The same task gives the same bytes on
  /// every process. Throws ProtocolError for bytes that are no task.
  virtual void perform(std::span<const std::byte> task, Bytes& result,
                       const Heartbeat& heartbeat) = 0;
  /// Appends its counts, for the report.
  virtual void write_counts(Bytes&) const {}
};

/// Collects results.
class ResultSink {
 public:
  ResultSink() = default;
  ResultSink(const ResultSink&) = delete;
  ResultSink& operator=(const ResultSink&) = delete;
  virtual ~ResultSink() = default;

  /// Results come in any order, each once. Returns the number of samples in it. Throws
  /// ProtocolError for bytes that are no result.
  virtual std::size_t accept(std::span<const std::byte> result) = 0;
};

}  // namespace beambench::cluster
