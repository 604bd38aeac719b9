#pragma once
// Converts the parts of a cell to events of a run's log, and back.

#include <nlohmann/json.hpp>

#include "harness/measure/record/cell_record.hpp"

namespace beambench::measure {

/// Returns a cell's identity, rays, counters and sizes: members of the event `cell`.
nlohmann::ordered_json facts_json(const CellRecord& cell);
/// Reads these members into a record. Throws nlohmann::json::exception if a member is missing or
/// has another type, and InputError if a name is unknown.
void read_facts(const nlohmann::ordered_json& event, CellRecord& cell);

nlohmann::ordered_json repetition_json(const Repetition& repetition);
Repetition read_repetition(const nlohmann::ordered_json& event);

/// Returns the classes of a cell's hits and their fingerprint. The cell must have both.
nlohmann::ordered_json verification_json(const CellRecord& cell);
void read_verification(const nlohmann::ordered_json& event, CellRecord& cell);

/// Returns verdict, stop reason, message, examples and time.
nlohmann::ordered_json finish_json(const CellRecord& cell);
void read_finish(const nlohmann::ordered_json& event, CellRecord& cell);

}  // namespace beambench::measure
