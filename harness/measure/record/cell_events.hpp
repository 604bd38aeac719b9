#pragma once
// Writes and reads the events of a cell in a run's log (run_log.hpp).

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "harness/measure/record/cell_record.hpp"

namespace beambench::measure {

/// Receives an event, to be logged or passed to the process that logs it.
using EventSink = std::function<void(const nlohmann::ordered_json& event)>;

/// Writes the events of cells to a sink.
class CellEvents {
 public:
  explicit CellEvents(EventSink sink) : sink_(std::move(sink)) {}

  void begin_cell(const CellRecord& cell) const;
  /// Adds the last of the cell's repetitions.
  void add_repetition(const CellRecord& cell) const;
  void add_verification(const CellRecord& cell) const;
  void finish_cell(const CellRecord& cell) const;
  void warn(const std::string& sentence) const;

 private:
  EventSink sink_;
};

/// Returns whether events of that kind belong to a cell.
bool is_of_cell(std::string_view kind);

/// Reads an event of a cell into its record. Throws InputError, or an exception of nlohmann-json,
/// if the event is malformed.
void apply(const nlohmann::ordered_json& event, CellRecord& cell);

}  // namespace beambench::measure
