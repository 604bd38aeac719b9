#pragma once
// What a reader noticed in a file and went on past.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace beambench::scenes::nff {

/// Collects remarks on a file. A file that gives cause for one may do so at each of a million
/// lines, so remarks with the same cause become one, with the first line and a count.
class NffNotes {
 public:
  /// `message` is the remark on the first line that has this cause.
  void add(const std::string& cause, const std::string& message);

  /// The remarks in the order of their first lines.
  std::vector<std::string> messages() const;

 private:
  struct Note {
    std::string message;
    std::size_t repetitions = 0;
  };
  std::vector<Note> notes_;
  std::map<std::string, std::size_t> by_cause_;  // indices into notes_
};

}  // namespace beambench::scenes::nff
