#pragma once
// Makes external text (names, tokens, paths) printable in messages, terminals and records.

#include <string>
#include <string_view>

namespace beambench {

/// Returns any bytes as UTF-8 without control characters. Bytes that are not UTF-8, and each byte
/// of control characters (C0, DEL, C1), line and paragraph separators, byte order marks and marks
/// that change the writing direction, are escaped as in `\x1b`. Everything else, including
/// backslashes, is kept, so printable text is unchanged.
std::string printable(std::string_view bytes);

/// Returns the beginning of a token for quotation in a message: in the form of `printable`, with
/// "..." instead of everything beyond 80 bytes.
std::string excerpt(std::string_view token);

/// Returns a message as one printable line of at most about 4,000 bytes: line ends and tabs become
/// blanks, and "..." replaces the middle of a longer message, so that the location at its beginning
/// and the remedy at its end remain.
std::string message_line(std::string_view message);

/// Returns the name of a file path in records and messages: in the form of `printable`, with
/// backslashes doubled so that `path_of_name` restores the same bytes. Most paths are unchanged.
std::string name_of_path(std::string_view path);

/// Returns the original path, byte for byte, from a name returned by `name_of_path`.
std::string path_of_name(std::string_view name);

/// Returns whether the bytes are valid UTF-8, which JSON requires.
bool is_utf8(std::string_view bytes);

}  // namespace beambench
