#pragma once
// The only functions that read and write JSON.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "scenes/base/error.hpp"

namespace beambench {

/// Parses a JSON text. `Json` is nlohmann::json or nlohmann::ordered_json; `file` names the text in
/// messages. Throws InputError, with line and column, if the text is not JSON, nests more than 64
/// levels deep (deeper documents overflow the stack of recursive code), has duplicate keys in one
/// object or holds a number that is too large for a double.
template <class Json>
Json parse_json(std::string_view text, const std::string& file);

/// Reads a JSON file of at most 64 MiB; a byte order mark is skipped. Throws like `read_text_input`
/// and `parse_json`.
template <class Json>
Json read_json_file(const std::filesystem::path& path);

/// Returns a document as text, with one element per line and each level indented by `indent`
/// blanks; -1 puts everything on one line. Bytes in strings that are not UTF-8 become the
/// replacement character.
std::string json_text(const nlohmann::json& document, int indent = 2);
std::string json_text(const nlohmann::ordered_json& document, int indent = 2);

/// Runs `read`, which extracts values from a document of `file` that beambench wrote. If a value is
/// missing or of another type, throws InputError with the file name and a remedy.
template <class Read>
std::invoke_result_t<Read> read_as_written(const std::string& file, std::string_view remedy,
                                           Read&& read) {
  try {
    return std::invoke(read);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": it is not as it was written (" + error.what() + "); " +
                     std::string(remedy));
  }
}

}  // namespace beambench
