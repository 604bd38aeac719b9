#pragma once
// The words and numbers of an NFF text, each with its line.

#include <cstddef>
#include <string>
#include <string_view>

namespace beambench {

/// One word or number. The text is empty at the end of the file.
struct NffToken {
  std::string_view text;
  std::size_t line = 1;
  bool starts_line = false;
};

/// Walks over the tokens of an NFF text: whatever stands between blanks, comments (`#` to the end
/// of the line) left out.
class NffTokens {
 public:
  /// The text must outlive this object; `file` is used in messages.
  NffTokens(std::string_view text, std::string file);

  const std::string& file() const { return file_; }
  const NffToken& peek() const { return token_; }
  bool at_end() const { return token_.text.empty(); }
  /// Whether the next token is, or tries to be, a number: `nan` and `1.2.3` count.
  bool at_number() const;
  /// How many numbers the rest of the text can hold at most.
  std::size_t most_numbers_left() const;

  NffToken take();
  /// Takes a number; `what` names it in messages. Refuses what is not a number from -1e9 to 1e9.
  double number(std::string_view what);
  /// Takes a number that must be an integer.
  long integer(std::string_view what);

  /// `file:line: message`
  std::string located(std::size_t line, std::string_view message) const;
  /// Throws InputError with the located message.
  [[noreturn]] void refuse(std::size_t line, std::string_view message) const;

 private:
  void advance();

  std::string file_;
  const char* position_;
  const char* end_;
  NffToken token_;
};

}  // namespace beambench
