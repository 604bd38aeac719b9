#pragma once
// Splits a text into lines and words.

#include <cstddef>
#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// Iterates over lines. All lines end like the first: with LF, CR LF or, as on old Macintoshes, CR
/// alone. A UTF-8 byte order mark before the first line is skipped.
class TextLines {
 public:
  /// Reads a text, which must outlive this object. `comment` begins a comment that extends to the
  /// end of the line; by default, there are none.
  explicit TextLines(std::string_view text, char comment = '\0');

  /// Moves to the next line; returns false at the end of the text.
  bool next();
  /// Moves to the next line that contains a word; returns false if there is none.
  bool next_with_words();
  /// Takes the next word of the line, between blanks; empty at its end.
  std::string_view word();
  /// Takes the next word of this line or of a later one; empty at the end of the text.
  std::string_view word_anywhere();
  /// Skips the rest of the line.
  void skip_line() { line_ = {}; }
  /// Returns the text after the line, byte for byte.
  std::string_view text_after() const { return rest_; }
  /// Throws InputError with the line number, the reason and the advice to export the file again.
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
