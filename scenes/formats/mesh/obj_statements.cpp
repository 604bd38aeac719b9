#include "scenes/formats/mesh/obj_statements.hpp"

#include <algorithm>
#include <array>

#include "scenes/formats/mesh/obj_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

struct Keyword {
  std::string_view word;
  ObjKind kind;
};

/// All keywords of the manual except `call` and `csh`, which include other files. `fo`, a face's
/// outline, "is no longer valid as of version 2.11. You can use f (face) to get the same results.
/// References to fo in existing .obj files will still be read". The last five are superseded
/// statements for curves, patches and their resolution.
constexpr std::array<Keyword, 43> kKeywords = {{
    {"v", ObjKind::kVertex},        {"vn", ObjKind::kAttribute},
    {"vt", ObjKind::kAttribute},    {"f", ObjKind::kFace},
    {"vp", ObjKind::kAttribute},    {"fo", ObjKind::kFace},
    {"p", ObjKind::kPointOrLine},   {"l", ObjKind::kPointOrLine},
    {"curv", ObjKind::kFreeForm},   {"curv2", ObjKind::kFreeForm},
    {"surf", ObjKind::kFreeForm},   {"cstype", ObjKind::kAttribute},
    {"deg", ObjKind::kAttribute},   {"bmat", ObjKind::kAttribute},
    {"step", ObjKind::kAttribute},  {"parm", ObjKind::kAttribute},
    {"trim", ObjKind::kAttribute},  {"hole", ObjKind::kAttribute},
    {"scrv", ObjKind::kAttribute},  {"sp", ObjKind::kAttribute},
    {"end", ObjKind::kAttribute},   {"con", ObjKind::kAttribute},
    {"g", ObjKind::kName},          {"o", ObjKind::kName},
    {"s", ObjKind::kAttribute},     {"mg", ObjKind::kAttribute},
    {"usemtl", ObjKind::kMaterial}, {"mtllib", ObjKind::kLibrary},
    {"usemap", ObjKind::kName},     {"maplib", ObjKind::kName},
    {"bevel", ObjKind::kAttribute}, {"c_interp", ObjKind::kAttribute},
    {"lod", ObjKind::kAttribute},   {"d_interp", ObjKind::kAttribute},
    {"shadow_obj", ObjKind::kName}, {"trace_obj", ObjKind::kName},
    {"ctech", ObjKind::kAttribute}, {"stech", ObjKind::kAttribute},
    {"bsp", ObjKind::kFreeForm},    {"bzp", ObjKind::kFreeForm},
    {"cdc", ObjKind::kFreeForm},    {"cdp", ObjKind::kFreeForm},
    {"res", ObjKind::kAttribute},
}};

ObjKind kind_of(std::string_view word) {
  if (word.empty() || word.starts_with('#')) return ObjKind::kNothing;
  const auto* const found = std::find_if(kKeywords.begin(), kKeywords.end(),
                                         [&](const Keyword& each) { return each.word == word; });
  return found == kKeywords.end() ? ObjKind::kUnknown : found->kind;
}

bool takes_numbers(ObjKind kind) {
  return kind == ObjKind::kVertex || kind == ObjKind::kFace || kind == ObjKind::kPointOrLine ||
         kind == ObjKind::kFreeForm || kind == ObjKind::kAttribute;
}

std::string_view before_comment(std::string_view line) { return line.substr(0, line.find('#')); }

}  // namespace

std::optional<ObjStatement> ObjStatements::next() {
  if (text_.empty()) return std::nullopt;
  std::string_view line = take_line(text_);
  ObjStatement statement;
  statement.line = ++line_;
  statement.word = take_word(line);
  if (line.empty() && statement.word.size() > 1 &&
      statement.word.ends_with('\\')) {  // `f\`, continued
    line = statement.word.substr(statement.word.size() - 1);
    statement.word.remove_suffix(1);
  }
  statement.kind = kind_of(statement.word);
  statement.rest = takes_numbers(statement.kind) ? numbers_from(line) : line;
  return statement;
}

/// Returns the numbers of the line and of its continuation lines.
std::string_view ObjStatements::numbers_from(std::string_view line) {
  line = before_comment(line);
  if (!line.ends_with('\\')) return line;
  joined_.clear();
  while (line.ends_with('\\')) {
    joined_ += line.substr(0, line.size() - 1);
    joined_ += ' ';
    if (!text_.empty()) ++line_;
    line = before_comment(take_line(text_));
  }
  joined_ += line;
  return joined_;
}

}  // namespace beambench::scenes::mesh
