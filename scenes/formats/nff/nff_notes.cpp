#include "scenes/formats/nff/nff_notes.hpp"

#include <fmt/format.h>

namespace beambench::scenes::nff {

void NffNotes::add(const std::string& cause, const std::string& message) {
  const auto [place, is_new] = by_cause_.try_emplace(cause, notes_.size());
  if (is_new) {
    notes_.push_back({message});
  } else {
    ++notes_[place->second].repetitions;
  }
}

std::vector<std::string> NffNotes::messages() const {
  std::vector<std::string> messages;
  for (const Note& note : notes_) {
    messages.push_back(note.repetitions == 0
                           ? note.message
                           : fmt::format("{} (and {} more)", note.message, note.repetitions));
  }
  return messages;
}

}  // namespace beambench::scenes::nff
