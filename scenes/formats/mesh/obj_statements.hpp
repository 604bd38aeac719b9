#pragma once
// The statements of an OBJ file: appendix B1, "Object Files (.obj)", of the manual of Wavefront's
// Advanced Visualizer (paulbourke.net/dataformats/obj).

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// The kind of a statement.
enum class ObjKind {
  kNothing,  ///< an empty line or a comment
  kVertex,
  kFace,
  kPointOrLine,
  kFreeForm,   ///< a curve or surface
  kLibrary,    ///< names a material library
  kMaterial,   ///< names the material of the faces that follow
  kName,       ///< anything else with a name
  kAttribute,  ///< numbers or switches that do not affect faces
  kUnknown,
};

struct ObjStatement {
  ObjKind kind = ObjKind::kNothing;
  std::size_t line = 0;   ///< line in which the statement begins, from 1
  std::string_view word;  ///< the first word
  std::string_view rest;  ///< the text after the word, valid until the next call of `next`
};

/// Iterates over the statements of an OBJ text, one per line. In statements with numbers, a
/// backslash at the end of a line continues the statement on the next line, as in all examples of
/// the manual, and a '#' begins a comment. Names and comments may contain any characters.
class ObjStatements {
 public:
  /// The text must outlive this object.
  explicit ObjStatements(std::string_view text) : text_(text) {}

  /// Returns the next statement; nothing at the end of the text.
  std::optional<ObjStatement> next();

 private:
  std::string_view numbers_from(std::string_view line);

  std::string_view text_;
  std::size_t line_ = 0;  // number of lines taken
  std::string joined_;    // the last statement of several lines
};

}  // namespace beambench::scenes::mesh
