#include "harness/measure/record/cell_events.hpp"

#include "harness/measure/record/cell_json.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

Json event_of(const char* kind, const CellRecord& cell, const Json& members) {
  Json event{{"event", kind}, {"index", cell.index}};
  event.update(members);
  return event;
}

}  // namespace

void CellEvents::begin_cell(const CellRecord& cell) const {
  sink_(event_of("cell", cell, facts_json(cell)));
}

void CellEvents::add_repetition(const CellRecord& cell) const {
  sink_(event_of("repetition", cell, repetition_json(cell.repetitions.back())));
}

void CellEvents::add_verification(const CellRecord& cell) const {
  sink_(event_of("verification", cell, verification_json(cell)));
}

void CellEvents::finish_cell(const CellRecord& cell) const {
  sink_(event_of("finished", cell, finish_json(cell)));
}

void CellEvents::warn(const std::string& sentence) const {
  sink_({{"event", "warning"}, {"text", sentence}});
}

bool is_of_cell(std::string_view kind) {
  return kind == "cell" || kind == "repetition" || kind == "verification" || kind == "finished";
}

void apply(const Json& event, CellRecord& cell) {
  const auto& kind = event.at("event").get_ref<const std::string&>();
  if (kind == "cell") return read_facts(event, cell);
  if (kind == "repetition") return cell.repetitions.push_back(read_repetition(event));
  if (kind == "verification") return read_verification(event, cell);
  read_finish(event, cell);
}

}  // namespace beambench::measure
