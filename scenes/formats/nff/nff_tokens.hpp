#pragma once
// The words and numbers of an NFF text, each with its line.

#include <cstddef>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace beambench::scenes::nff {

/// Comment lines that begin with this word, which other programs ignore, are read as if this word
/// were absent.
inline constexpr std::string_view kOwnComment = "#beambench";

/// One word or number. The text is empty at the end of the file.
struct NffToken {
  std::string_view text;
  std::size_t line = 1;
  bool starts_line = false;
};

/// Iterates over the tokens of an NFF text: everything between blanks, without comments (`#` to the
/// end of the line), except those that begin with `kOwnComment`. Lines end with "\n", "\r\n" or
/// "\r".
class NffTokens {
 public:
  /// The text must outlive this object; `file` is used in messages.
  NffTokens(std::string_view text, std::string_view file);

  const std::string& file() const { return file_; }
  const NffToken& peek() const { return token_; }
  bool at_end() const { return token_.text.empty(); }
  /// Returns whether the next token is, or is meant to be, a number: `nan` and `1.2.3` count.
  bool at_number() const;
  /// Returns an upper bound on the numbers in the rest of the text.
  std::size_t max_numbers_left() const;

  NffToken take();
  /// Takes a number, rounded once; `what` names it in messages. Throws unless it is a number from
  /// -1e9 to 1e9.
  float number(std::string_view what);
  glm::vec3 triple(std::string_view what);
  /// Takes an integer.
  long integer(std::string_view what);
  /// Takes the rest of the line after `word`, the last token taken, without a comment and
  /// surrounding blanks. Throws if nothing is left.
  std::string_view rest_of_line(const NffToken& word, std::string_view what);

  /// Returns `file:line: message`.
  std::string located(std::size_t line, std::string_view message) const;
  /// Throws InputError with the located message.
  [[noreturn]] void refuse(std::size_t line, std::string_view message) const;

 private:
  void advance();
  bool at_line_end() const;  // after the last character of a line
  bool at_own_comment() const;
  template <typename Number>
  Number take_number(std::string_view what);

  std::string file_;
  const char* position_;
  const char* end_;
  NffToken token_;
};

}  // namespace beambench::scenes::nff
