#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/base/process_memory.hpp"
#include "tests/scenes/imported.hpp"
#include "tests/scenes/mesh_files.hpp"

namespace beambench::scenes {
namespace {

std::uint64_t off_hash(const std::string& text) { return imported_hash(text, "off"); }

std::string off_refusal(const std::string& text) { return refusal(text, "off"); }

/// Returns a tetrahedron's rows after the header, with a string appended to each vertex and face.
std::string tetrahedron_rows(std::string_view of_vertex, std::string_view of_face) {
  std::string text;
  for (const char* vertex : {"0 0 0", "1 0 0", "0 2 0", "0 0 3"}) {
    text += fmt::format("{}{}\n", vertex, of_vertex);
  }
  for (const char* face : {"3 0 2 1", "3 0 1 3", "3 1 2 3", "3 0 3 2"}) {
    text += fmt::format("{}{}\n", face, of_face);
  }
  return text;
}

std::string triangle_off(const std::string& first, const std::string& face = "3 0 1 2") {
  return "OFF\n3 1 3\n" + first + "\n1 0 0\n0 1 0\n" + face + "\n";
}

TEST(Off, HeadersOfEveryDialectAreRead) {
  for (const char* header :
       {"OFF\n4 4 0\n", "OFF 4 4 0\n", "OFF4 4 0\n", "4 4 0\n", "OFF\n4\n4\n6\n",
        "# a\nOFF # b\n# c\n\n4 4 # d\n\t0\n", " OFF\t\n 4  4\t6 \n", "OFF\n4 4 -1\n"}) {
    EXPECT_EQ(off_hash(header + tetrahedron_rows("", "")), tetrahedron_hash()) << header;
  }
  EXPECT_EQ(off_hash("\xEF\xBB\xBFOFF\n4 4 0\n" + tetrahedron_rows("", "")), tetrahedron_hash());
}

TEST(Off, ColorsNormalsAndTexturesAreSkipped) {
  for (const auto& [keyword, numbers] :
       std::vector<std::pair<std::string, std::string>>{{"COFF", " 255 0 0 255"},
                                                        {"COFF", " 0.5 0.5 0.5"},
                                                        {"NOFF", " 0 0 1"},
                                                        {"STOFF", " 0.5 1"},
                                                        {"CNOFF", " 0 0 1 1 0 0 1"},
                                                        {"NCOFF", " 0 0 1 1 0 0"},
                                                        {"STCNOFF", " 0 0 1 1 0 0 1 0.5 1"},
                                                        {"NCSTOFF", " 1 0 0 0 0 1 0.5 1"}}) {
    EXPECT_EQ(off_hash(keyword + "\n4 4 0\n" + tetrahedron_rows(numbers, "")), tetrahedron_hash())
        << keyword;
  }
  for (const char* color : {"", " 7", " 255 0 0", " 255 0 0 128", " 0.5 0.25 1", " 1 0 0 0.5",
                            "\t1.0 0 0  ", " # 1 2 3 4 5", " 1 0 0 # red"}) {
    EXPECT_EQ(off_hash("OFF\n4 4 0\n" + tetrahedron_rows("", color)), tetrahedron_hash()) << color;
  }
}

/// Assimp issue 2228, trimesh issue 542: a face was lost.
TEST(Off, CommentsAndEmptyLinesMayAppearAnywhere) {
  std::string text;
  for (const char c : "#!\nOFF\n4 4 0\n" + tetrahedron_rows("", "")) {
    text += c;
    if (c == '\n') text += "# a comment: 3 0 1 2\n\n  \t\n#\n";
  }
  EXPECT_EQ(off_hash(text), tetrahedron_hash());
}

TEST(Off, LinesEndInEachWay) {
  for (const char* line_end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : tetrahedron_off()) {
      if (c == '\n') {
        text += line_end;
      } else {
        text += c;
      }
    }
    EXPECT_EQ(off_hash(text), tetrahedron_hash());
  }
  const std::string text = tetrahedron_off();
  EXPECT_EQ(off_hash(text.substr(0, text.size() - 1)), tetrahedron_hash()) << "no last line end";
}

TEST(Off, DialectsWithoutThreeDimensionsAreRefused) {
  for (const char* keyword : {"4OFF", "nOFF", "4nOFF", "ST4OFF", "CN4nOFF"}) {
    EXPECT_TRUE(
        says(off_refusal(std::string(keyword) + "\n4 4 0\n" + tetrahedron_rows(" 1", "")),
             {"a.off: ", "OFF' files", "other than three coordinates", "export it as OFF"}));
  }
  EXPECT_TRUE(says(off_refusal("OFF BINARY\n" + std::string(40, '\0')),
                   {"a.off: ", "binary OFF", "as text"}));
  EXPECT_TRUE(says(off_refusal("COFF BINARY\n"), {"binary OFF"}));
}

TEST(Off, AWrongHeaderIsRefusedWithItsLine) {
  for (const auto& [header, words] :
       std::vector<std::pair<std::string, std::vector<std::string_view>>>{
           {"# only\n", {"no text"}},
           {"off\n4 4 0\n", {"line 1: ", "does not begin with 'OFF'"}},
           {"XOFF\n4 4 0\n", {"line 1: ", "does not begin with 'OFF'"}},
           {"OFFX\n4 4 0\n", {"line 1: ", "'OFFX'"}},
           {"ply\n", {"line 1: ", "does not begin with 'OFF'"}},
           {"4.0 4 0\n", {"line 1: "}},
           {"OFF\n4 4\n", {"line 3: ", "'0' follows the numbers"}},
           {"OFF\n4 4 0 0\n", {"line 2: ", "'0' follows the numbers"}},
           {"OFF\n4 x 0\n", {"line 2: ", "'x'"}},
           {"OFF\n4.5 4 0\n", {"line 2: ", "'4.5'"}},
           {"OFF\n-4 4 0\n", {"line 2: ", "negative"}},
           {"OFF\n4 -4 0\n", {"line 2: ", "negative"}}}) {
    const std::string rest = header[0] == '#' ? "" : tetrahedron_rows("", "");
    const std::string message = off_refusal(header + rest);
    EXPECT_TRUE(says(message, {"a.off: "})) << header;
    for (const std::string_view word : words) EXPECT_TRUE(says(message, {word})) << header;
  }
}

TEST(Off, APointCloudIsRefusedWithItsOwnMessage) {
  EXPECT_TRUE(says(off_refusal("OFF\n1 0 0\n0 0 0\n"),
                   {"a.off: ", "declares 1 vertex but no faces", "point cloud"}));
}

TEST(Off, AnInvalidNumberIsRefusedWithItsLine) {
  for (const char* word : {"1,5", "x", "1e", "0x1"}) {
    EXPECT_TRUE(says(off_refusal(triangle_off(fmt::format("0 {} 0", word))),
                     {"a.off: line 3: vertex 0: ", fmt::format("'{}' is not a number", word)}));
    EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0", fmt::format("3 0 1 2 {}", word))),
                     {"a.off: line 6: face 0: ", fmt::format("'{}' is not a number", word)}));
  }
  EXPECT_TRUE(says(off_refusal(triangle_off("0 1.#QNAN 0")), {"line 3: vertex 0 has fewer"}))
      << "# begins a comment";
  EXPECT_TRUE(says(off_refusal(triangle_off("nan 0 0")), {"coordinate nan", "1e9"}));
}

TEST(Off, RowsThatAreTooShortOrTooLongAreRefused) {
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0")), {"line 3: vertex 0 has fewer than three"}));
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0 1")), {"line 3: vertex 0 has 1 number after"}));
  EXPECT_TRUE(
      says(off_refusal("COFF\n3 1 0\n0 0 0 1 1\n"), {"line 3: vertex 0 has 2 numbers after"}));
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0", "3 0 1")),
                   {"line 6: face 0 has 2 corners, but declares 3"}));
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0", "3 0 1 2 1 1 1 1 1")),
                   {"line 6: face 0 has 5 numbers after its corners"}));
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0", "-3 0 1 2")), {"line 6: ", "'-3'"}));
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0", "3.0 0 1 2")), {"line 6: ", "'3.0'"}));
}

TEST(Off, MissingVerticesAreRefused) {
  for (const char* index : {"3", "9", "-1", "4294967298", "1.5"}) {
    EXPECT_TRUE(
        says(off_refusal(triangle_off("0 0 0", fmt::format("3 0 1 {}", index))),
             {"a.off: line 6: face 0 refers to vertex ", fmt::format("'{}'", index), "only 3"}));
  }
}

TEST(Off, AFileTruncatedAnywhereIsRefused) {
  const std::string text = tetrahedron_off();
  for (std::size_t size = 0; size + 1 < text.size(); ++size) {
    EXPECT_NE(off_refusal(text.substr(0, size)), "(nothing thrown)") << size;
  }
  EXPECT_TRUE(says(off_refusal(text.substr(0, text.size() - 8)),
                   {"declares 4 faces", "after 3", "cut off"}));
}

TEST(Off, WhatFollowsTheLastFaceIsRefused) {
  EXPECT_TRUE(says(off_refusal(triangle_off("0 0 0") + "# a comment is nothing\n3 0 1 2\n"),
                   {"a.off: line 8: '3' follows the last face"}));
}

TEST(Off, AHugeCountAllocatesNoMemory) {
  for (const char* counts : {"4000000000000 4 0", "4 4000000000000 0"}) {
    std::string message;
    const auto growth = peak_memory_growth(
        [&] { message = off_refusal(with_count(tetrahedron_off(), "4 4 0", counts)); });
    EXPECT_NE(message, "(nothing thrown)");
    EXPECT_LT(growth.value_or(0), std::uint64_t{16} << 20U);
  }
}

TEST(Off, FacesWithoutAreaArePointsLinesOrNothing) {
  const auto mesh = imported(
      "OFF\n4 7 0\n" + with_count(tetrahedron_rows("", ""), "3 0 2 1", "0\n1 2\n2 0 1\n3 0 2 1"),
      "off");
  EXPECT_EQ(mesh.mesh.triangles.size(), 4U);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"2 points and lines"}));
}

TEST(Off, CoordinatesAreRoundedOnce) {
  const auto x = [](const std::string& text) {
    return triangles_of(imported(triangle_off(text + " 0 0"), "off"))[0][0].x;
  };
  EXPECT_EQ(x("0.000000000000000123456"), 0.000000000000000123456F);
  EXPECT_EQ(x("0.50000002980232238769531250000000000000001"), 0x1.000002p-1F);
}

}  // namespace
}  // namespace beambench::scenes
