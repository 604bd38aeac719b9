#pragma once
// The lines of a text, and the words of each.

#include <cstddef>
#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// Iterates over lines. They end as the first one does: with LF, with CR LF or, as on old
/// Macintoshes, with CR alone. A byte order mark of UTF-8 before the first is skipped.
class TextLines {
 public:
  /// The text must outlive this object. A line ends for its reader where `comment` stands in it;
  /// without one, nothing is a comment.
  explicit TextLines(std::string_view text, char comment = '\0');

  /// Goes to the next line; false at the end of the text.
  bool next();
  /// Goes to the next line that has a word; false where none has.
  bool next_with_words();
  /// Takes the next word of the line, between blanks; empty at its end.
  std::string_view word();
  /// Takes the next word of this line or of a later one; empty at the end of the text.
  std::string_view word_anywhere();
  /// Leaves the rest of the line out.
  void skip_line() { line_ = {}; }
  /// Returns what follows the line, byte for byte.
  std::string_view text_after() const { return rest_; }
  /// Throws InputError: the line's number, what is wrong there, and that the file should be
  /// exported again.
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  std::string_view line_;
  std::string_view rest_;
  char end_;
  char comment_;
  std::size_t number_ = 0;
};

/// Returns "1 vertex", "8 vertices": a count with its noun.
std::string counted(std::size_t count, std::string_view one, std::string_view several);

}  // namespace beambench::scenes::mesh
