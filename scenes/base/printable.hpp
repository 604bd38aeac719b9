#pragma once
// Text from outside (names, tokens, paths) as messages, terminals and records show it.

#include <string>
#include <string_view>

namespace beambench {

/// Any bytes as UTF-8 without control characters: a byte that is not UTF-8, and each byte of a
/// control character (C0, DEL, C1), a line or paragraph separator, a byte order mark or a mark that
/// changes the direction of writing, becomes `\x1b`. All else, backslashes too, stays, so that what
/// is printable already stays as it is.
std::string printable(std::string_view bytes);

/// The beginning of a token that a message quotes: `printable`, with "..." in place of what goes
/// beyond 80 bytes.
std::string excerpt(std::string_view token);

/// A message as one printable line of at most some 4,000 bytes: line ends and tabs become blanks,
/// and "..." stands for the middle of what is longer, so that the place at its beginning and the
/// remedy at its end remain.
std::string message_line(std::string_view message);

/// The name that records and messages have for a file that is opened by a path: `printable`, with
/// backslashes doubled, so that `path_of_name` leads back to the same bytes. Most paths are their
/// own names.
std::string name_of_path(std::string_view path);

/// The path, byte for byte, of a name that `name_of_path` made.
std::string path_of_name(std::string_view name);

/// Whether the bytes are UTF-8, which texts of JSON have to be.
bool is_utf8(std::string_view bytes);

}  // namespace beambench
