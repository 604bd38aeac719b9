#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/core/process_memory.hpp"
#include "scenes/core/random.hpp"
#include "tests/ply_file.hpp"
#include "tests/scenes/imported.hpp"
#include "tests/scenes/mesh_files.hpp"

namespace beambench::scenes {
namespace {

using tests::kPlyEncodings;
using tests::ply_file;
using tests::PlyNumber;
using tests::PlyRow;

std::string vertices(std::size_t count, std::string_view type = "float") {
  return fmt::format("element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n", count,
                     type, type, type);
}

std::string faces(std::size_t count, std::string_view types = "uchar int") {
  return fmt::format("element face {}\nproperty list {} vertex_indices\n", count, types);
}

/// The corners of a tetrahedron (0,0,0), (1,0,0), (0,2,0), (0,0,3).
std::vector<PlyRow> corners(std::string_view type = "float") {
  return {{{type, 0}, {type, 0}, {type, 0}},
          {{type, 1}, {type, 0}, {type, 0}},
          {{type, 0}, {type, 2}, {type, 0}},
          {{type, 0}, {type, 0}, {type, 3}}};
}

PlyRow list(std::string_view length_type, std::string_view type, const std::vector<int>& numbers) {
  PlyRow row = {{length_type, static_cast<double>(numbers.size())}};
  for (const int number : numbers) row.push_back({type, static_cast<double>(number)});
  return row;
}

const std::vector<std::vector<int>> kTetrahedronFaces = {
    {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

std::vector<PlyRow> tetrahedron_faces(std::string_view length_type = "uchar",
                                      std::string_view type = "int") {
  std::vector<PlyRow> rows;
  for (const auto& face : kTetrahedronFaces) rows.push_back(list(length_type, type, face));
  return rows;
}

std::vector<PlyRow> operator+(std::vector<PlyRow> rows, const std::vector<PlyRow>& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

std::uint64_t tetrahedron_hash() { return imported_hash(tetrahedron_ply(), "ply"); }

std::uint64_t ply_hash(const std::string& bytes) { return imported_hash(bytes, "ply"); }

std::string ply_refusal(const std::string& bytes) { return refusal(bytes, "ply"); }

/// A text file of three vertices, the first of which is given, and a triangle.
std::string triangle_ply(const std::string& first, const std::string& face = "3 0 1 2") {
  return ply_file("ascii", vertices(3) + faces(1), {}) + first + "\n1 0 0\n0 1 0\n" + face + "\n";
}

// Encodings and types

TEST(Ply, IsTheSameMeshInEachEncodingAndOfEachType) {
  const std::uint64_t hash = imported_hash(tetrahedron_off(), "off");
  for (const std::string_view encoding : kPlyEncodings) {
    for (const char* type :
         {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32",
          "uint", "uint32", "float", "float32", "double", "float64"}) {
      SCOPED_TRACE(fmt::format("{} {}", encoding, type));
      EXPECT_EQ(ply_hash(ply_file(encoding, vertices(4, type) + faces(4),
                                  corners(type) + tetrahedron_faces())),
                hash);
    }
  }
}

TEST(Ply, ListsAreOfEveryType) {
  for (const std::string_view encoding : kPlyEncodings) {
    for (const char* length : {"char", "uchar", "short", "uint16", "int32", "uint"}) {
      for (const char* type :
           {"int8", "uint8", "int16", "ushort", "int", "uint32", "float", "double"}) {
        for (const char* name : {"vertex_index", "vertex_indices"}) {
          SCOPED_TRACE(fmt::format("{} {} {} {}", encoding, length, type, name));
          const std::string declarations =
              vertices(4) +
              fmt::format("element face 4\nproperty list {} {} {}\n", length, type, name);
          EXPECT_EQ(ply_hash(ply_file(encoding, declarations,
                                      corners() + tetrahedron_faces(length, type))),
                    tetrahedron_hash());
        }
      }
    }
  }
}

/// trimesh issue 724: another element's row became a vertex.
TEST(Ply, OtherElementsAndPropertiesAreSkippedWhereverTheyStand) {
  const std::string camera =
      "element camera 2\nproperty double view\nproperty list ushort short p\n";
  const std::vector<PlyRow> camera_rows = {
      {{"double", 7.5}, {"ushort", 2}, {"short", -1}, {"short", 5}},
      {{"double", 1}, {"ushort", 0}}};
  const std::string decorated =
      "element vertex 4\nproperty uchar red\nproperty float x\nproperty list uchar float weights\n"
      "property float y\nproperty float z\nproperty double confidence\n";
  std::vector<PlyRow> decorated_rows;
  for (const PlyRow& row : corners()) {
    decorated_rows.push_back({{"uchar", 200},
                              row[0],
                              {"uchar", 2},
                              {"float", 0.5},
                              {"float", 9},
                              row[1],
                              row[2],
                              {"double", 0.25}});
  }
  const std::string face =
      "element face 4\nproperty list uchar float texcoord\nproperty list uchar int vertex_indices\n"
      "property uchar flags\n";
  std::vector<PlyRow> face_rows;
  for (const auto& corners_of_face : kTetrahedronFaces) {
    PlyRow row = {{"uchar", 1}, {"float", 0.5}};
    const PlyRow numbers = list("uchar", "int", corners_of_face);
    row.insert(row.end(), numbers.begin(), numbers.end());
    row.push_back({"uchar", 3});
    face_rows.push_back(row);
  }
  for (const std::string_view encoding : kPlyEncodings) {
    SCOPED_TRACE(encoding);
    EXPECT_EQ(ply_hash(ply_file(encoding, camera + decorated + "element none 0\n" + face,
                                camera_rows + decorated_rows + face_rows)),
              tetrahedron_hash());
    EXPECT_EQ(ply_hash(ply_file(encoding, face + decorated + camera,
                                face_rows + decorated_rows + camera_rows)),
              tetrahedron_hash())
        << "faces before vertices";
  }
}

/// Assimp issue 6296, miniply issue 1: only the first triangle was read.
TEST(Ply, StripsAreTrianglesOfAlternatingOrientation) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::vector<std::vector<int>> triangles = {{0, 1, 2}, {2, 1, 3}, {3, 2, 1}, {0, 2, 1}};
  std::vector<PlyRow> as_faces;
  for (const auto& triangle : triangles) as_faces.push_back(list("uchar", "int", triangle));
  for (const std::string_view encoding : kPlyEncodings) {
    SCOPED_TRACE(encoding);
    const std::uint64_t hash =
        ply_hash(ply_file(encoding, vertices(4) + faces(4), corners() + as_faces));
    EXPECT_EQ(ply_hash(ply_file(
                  encoding, vertices(4) + strips,
                  corners() + std::vector<PlyRow>{list(
                                  "int", "int", {0, 1, 2, 3, -1, 3, 2, 1, -1, 0, -1, 0, 2, 1})})),
              hash);
    EXPECT_EQ(ply_hash(ply_file(encoding, strips + vertices(4),
                                std::vector<PlyRow>{list(
                                    "int", "int", {0, 1, 2, 3, -1, -1, 3, 2, 1, -1, 0, 2, 1, -1})} +
                                    corners())),
              hash);
  }
}

TEST(Ply, TrianglesOfStripsWithoutAreaAreLeftOutAndCounted) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const auto mesh =
      imported(ply_file("ascii", vertices(4) + strips,
                        corners() + std::vector<PlyRow>{list("int", "int", {0, 1, 2, 2, 1, 3})}),
               "ply");
  EXPECT_EQ(mesh.mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"2 triangles without area", "triangle 1"}));
}

/// Assimp issue 2864: the file was refused.
TEST(Ply, AFaceWithoutVerticesIsNone) {
  for (const std::string_view encoding : kPlyEncodings) {
    const auto mesh = imported(
        ply_file(encoding, vertices(4) + faces(5),
                 corners() + std::vector<PlyRow>{list("uchar", "int", {})} + tetrahedron_faces()),
        "ply");
    EXPECT_EQ(mesh.mesh.triangles.size(), 4U);
    EXPECT_TRUE(mesh.warnings.empty());
  }
}

TEST(Ply, FacesOfOneOrTwoVerticesAreLeftOutAndCounted) {
  const auto mesh = imported(
      ply_file("ascii", vertices(4) + faces(6),
               corners() +
                   std::vector<PlyRow>{list("uchar", "int", {1}), list("uchar", "int", {0, 1})} +
                   tetrahedron_faces()),
      "ply");
  EXPECT_EQ(mesh.mesh.triangles.size(), 4U);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"2 points and lines"}));
}

TEST(Ply, PolygonsAreTriangulatedAsThoseOfObjFiles) {
  if (mesh::importer_of("obj").empty()) GTEST_SKIP() << "built without tinyobjloader";
  const std::string places = "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n";
  const std::string ply =
      ply_file("ascii", vertices(5) + faces(2), {}) + places + "5 0 1 2 3 4\n4 3 2 1 0\n";
  const std::string obj = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\nf 4 3 2 1\n";
  EXPECT_EQ(ply_hash(ply), imported_hash(obj, "obj"));
}

// The header

/// Assimp issues 4866 and 819: z was 0, or the file was refused.
TEST(Ply, CommentsAndBlanksMayStandAnywhereInTheHeader) {
  const std::string declarations =
      "comment a\nobj_info b\nelement  vertex\t4 \ncomment element face 9\n\n"
      "  property float x\ncomment between\nobj_info\nproperty\tfloat  y\n \t\nproperty float z\n"
      "comment\nelement face 4\ncomment property float w\n"
      "property   list uchar\tint vertex_indices\nobj_info last\n";
  for (const std::string_view encoding : kPlyEncodings) {
    for (const char* line_end : {"\n", "\r\n", "\r"}) {
      for (const char* mark : {"", "\xEF\xBB\xBF"}) {
        SCOPED_TRACE(fmt::format("{} {:?}", encoding, line_end));
        std::string bytes =
            ply_file(encoding, declarations, corners() + tetrahedron_faces(), line_end);
        bytes = mark + with_count(bytes, "ply", fmt::format("ply{}comment first", line_end));
        EXPECT_EQ(ply_hash(bytes), tetrahedron_hash());
      }
    }
  }
}

TEST(Ply, TheFormatMayStandAnywhereInTheHeader) {
  const std::string text = tetrahedron_ply();
  const std::string format = "format ascii 1.0\n";
  const std::string without = with_count(text, format, "");
  EXPECT_EQ(ply_hash(with_count(without, "end_header\n", format + "end_header\n")),
            tetrahedron_hash());
}

/// Assimp issue 4755: what looks like the end of a line was taken off the data.
TEST(Ply, BinaryDataMayBeginWithAnyByte) {
  for (const std::string_view encoding : {kPlyEncodings[1], kPlyEncodings[2]}) {
    for (int first = 0; first < 256; ++first) {
      for (const char* line_end : {"\n", "\r\n", "\r"}) {
        SCOPED_TRACE(fmt::format("{} {} {:?}", encoding, first, line_end));
        const std::string declarations =
            "element first 1\nproperty uchar byte\n" + vertices(4) + faces(4);
        EXPECT_EQ(ply_hash(ply_file(encoding, declarations,
                                    std::vector<PlyRow>{{{"uchar", static_cast<double>(first)}}} +
                                        corners() + tetrahedron_faces(),
                                    line_end)),
                  tetrahedron_hash());
      }
    }
  }
}

TEST(Ply, AWrongHeaderIsRefusedWithItsLine) {
  struct Case {
    std::string old;
    std::string by;
    std::vector<std::string_view> says;
  };
  const std::vector<Case> cases = {
      {"ply\n", "PLY\n", {"line 1: ", "does not begin with 'ply'"}},
      {"ply\n", "ply 2\n", {"line 1: ", "'2'"}},
      {"ascii 1.0", "ascii 2.0", {"line 2: ", "'ascii 2.0'", "binary_big_endian"}},
      {"format ascii 1.0\n", "", {"without the line 'format'"}},
      {"format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n", {"line 3: ", "twice"}},
      {"comment", "remark", {"line 3: ", "'remark'"}},
      {"vertex 4", "vertex", {"line 4: ", "''", "'vertex'"}},
      {"vertex 4", "vertex -4", {"line 4: ", "'-4'", "'vertex'"}},
      {"vertex 4", "vertex 4.0", {"line 4: ", "'4.0'"}},
      {"vertex 4", "vertex 4 4", {"line 4: ", "'4' follows"}},
      {"vertex 4", "vertex 99999999999999999999", {"line 4: ", "no number of rows"}},
      {"float x", "real x", {"line 5: ", "'real' is no type"}},
      {"float x", "float", {"line 5: ", "no name"}},
      {"float x", "float y", {"line 6: ", "'y' is declared twice"}},
      {"element face", "element vertex", {"line 8: ", "'vertex' is declared twice"}},
      {"uchar int", "float int", {"line 9: ", "integer type"}},
      {"uchar int", "uchar", {"line 9: ", "'vertex_indices' is no type"}},
      {"element vertex 4\n", "", {"line 4: ", "before the first element"}},
      {"float z", "float w", {"element 'vertex' without 'z'"}},
      {"float z", "list uchar float z", {"'z' in place of a number"}},
      {"list uchar int vertex_indices", "int vertex_indices", {"'vertex_indices' that is no list"}},
      {"int vertex_indices", "int corners", {"'face' with 0 lists"}},
      {"int vertex_indices\n",
       "int vertex_indices\nproperty list uchar int vertex_index\n",
       {"'face' with 2 lists"}},
      {"end_header", "end_head", {"line 10: ", "'end_head'"}},
      {"end_header", "end_header 1", {"line 10: ", "'1' follows"}},
  };
  for (const Case& one : cases) {
    const std::string message = ply_refusal(with_count(tetrahedron_ply(), one.old, one.by));
    EXPECT_TRUE(says(message, {"a.ply: "})) << one.by;
    for (const std::string_view word : one.says) EXPECT_TRUE(says(message, {word})) << one.by;
  }
  const std::string text = tetrahedron_ply();
  EXPECT_TRUE(says(ply_refusal(text.substr(0, text.find("end_header"))),
                   {"the file ends before 'end_header'"}));
}

TEST(Ply, APointCloudIsRefusedInWordsOfOurOwn) {
  for (const std::string_view encoding : kPlyEncodings) {
    for (const std::string& declarations : {vertices(4), vertices(4) + faces(0)}) {
      EXPECT_TRUE(says(ply_refusal(ply_file(encoding, declarations, corners())),
                       {"a.ply: ", "declares 4 vertices but no faces", "point cloud"}));
    }
  }
}

TEST(Ply, RowsWithoutPropertiesAreRefused) {
  for (const std::string_view encoding : kPlyEncodings) {
    EXPECT_TRUE(says(ply_refusal(ply_file(encoding, "element vertex 1000000000000000000\n", {})),
                     {"declares 1000000000000000000 of the element 'vertex'", "no property"}));
  }
}

// The rows

TEST(Ply, WhatIsNoNumberIsRefusedWithItsLine) {
  for (const char* word : {"1.#QNAN", "-1.#IND", "1,5", "0x10", "1e", "1.2.3", "--1", "+-1", "x",
                           "1d5", "1_000", "1f"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply(fmt::format("0 {} 0", word))),
                     {"a.ply: line 10: vertex 0: ", fmt::format("'{}'", word), "type float"}));
  }
  EXPECT_TRUE(says(ply_refusal(triangle_ply("nan 0 0")), {"coordinate nan", "1e9"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("1e999 0 0")), {"coordinate inf", "1e9"}));
}

TEST(Ply, EveryWayToWriteANumberIsRead) {
  for (const char* word : {"0.5", ".5", "+.5", "5e-1", "5E-01", "0.50000000000000000000", "+0.5"}) {
    const auto mesh = imported(triangle_ply(fmt::format("{} 0 0", word)), "ply");
    EXPECT_EQ(triangles_of(mesh)[0][0], glm::vec3(0.5F, 0.0F, 0.0F)) << word;
  }
}

TEST(Ply, RowsThatAreTooShortOrTooLongAreRefused) {
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0")), {"line 10: vertex 0: the line ends before"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0 7")), {"line 10: vertex 0: '7' follows"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "3 0 1")), {"line 13: face 0: ", "ends"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "3 0 1 2 0")), {"face 0: '0' follows"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "-3 0 1 2")), {"'-3'", "type uchar"}));
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", "259 0 1 2")), {"'259'", "type uchar"}));
  EXPECT_NO_THROW(imported(triangle_ply("\n0 0 0\n", "\n\n3 0 1 2\n \n"), "ply")) << "empty lines";
}

TEST(Ply, VerticesThatAreNotThereAreRefused) {
  for (const char* index : {"3", "-1", "2147483647"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", fmt::format("3 0 1 {}", index))),
                     {"line 13: face 0: ", fmt::format("the vertex {},", index), "only 3"}));
  }
  for (const char* index : {"4294967298", "1.5", "1e0", "1,"}) {
    EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0", fmt::format("3 0 1 {}", index))),
                     {"line 13: face 0: ", fmt::format("'{}'", index), "type int"}));
  }
  const std::string real = ply_file("ascii", vertices(3) + faces(1, "uchar float"), {});
  for (const char* index : {"1.5", "nan", "inf", "1e30"}) {
    EXPECT_TRUE(says(ply_refusal(real + "0 0 0\n1 0 0\n0 1 0\n3 0 1 " + index + "\n"),
                     {"line 13: face 0: ", "no number of a vertex"}));
  }
  for (const std::string_view encoding : {kPlyEncodings[1], kPlyEncodings[2]}) {
    const std::string bytes = ply_file(
        encoding, vertices(4) + faces(1, "uchar uint"),
        corners() +
            std::vector<PlyRow>{{{"uchar", 3}, {"uint", 0}, {"uint", 1}, {"uint", 4294967295.0}}});
    EXPECT_TRUE(says(ply_refusal(bytes), {fmt::format("byte {}: face 0: ", bytes.size()),
                                          "the vertex 4294967295", "only 4"}));
  }
}

TEST(Ply, AListOfNegativeLengthIsRefused) {
  for (const std::string_view encoding : kPlyEncodings) {
    EXPECT_TRUE(says(ply_refusal(ply_file(encoding, vertices(4) + faces(1, "char int"),
                                          corners() + std::vector<PlyRow>{{{"char", -1}}})),
                     {"face 0: ", "length -1"}));
  }
}

TEST(Ply, AFileThatIsCutOffAnywhereIsRefused) {
  for (const std::string_view encoding : kPlyEncodings) {
    const std::string bytes =
        ply_file(encoding, vertices(4) + faces(4), corners() + tetrahedron_faces());
    const std::size_t last = bytes.size() - (encoding == "ascii" ? 1 : 0);  // the last line's end
    for (std::size_t size = 0; size < last; ++size) {
      EXPECT_NE(ply_refusal(bytes.substr(0, size)), "(nothing thrown)") << encoding << ' ' << size;
    }
  }
}

TEST(Ply, WhatFollowsTheLastRowIsRefused) {
  EXPECT_TRUE(says(ply_refusal(triangle_ply("0 0 0") + "3 0 1 2\n"),
                   {"a.ply: line 14: '3' follows the last row"}));
  const std::string bytes =
      ply_file("binary_big_endian", vertices(4) + faces(4), corners() + tetrahedron_faces());
  EXPECT_TRUE(says(ply_refusal(bytes + '\n'),
                   {fmt::format("a.ply: byte {}: one byte follows", bytes.size())}));
  EXPECT_TRUE(says(ply_refusal(bytes + "end"), {"3 bytes follow"}));
}

TEST(Ply, AHugeCountTakesNoMemory) {
  for (const std::string_view encoding : kPlyEncodings) {
    for (const char* types : {"uchar int", "uint int"}) {
      for (const std::string& declarations :
           {vertices(4) + faces(4'000'000'000'000, types), vertices(4'000'000'000'000) + faces(4),
            "element a 4000000000000\nproperty list uint double b\n" + vertices(4) + faces(4)}) {
        std::string message;
        const auto growth = peak_memory_growth([&] {
          message = ply_refusal(ply_file(
              encoding, declarations, corners() + std::vector<PlyRow>{{{"uint", 4294967295.0}}}));
        });
        EXPECT_NE(message, "(nothing thrown)");
        EXPECT_LT(growth.value_or(0), std::uint64_t{16} << 20U) << message;
      }
    }
  }
}

// Numbers

/// Assimp issue 3573: up to a fifth of the coordinates were off by one or two units.
TEST(Ply, CoordinatesAreTheNearestFloats) {
  EXPECT_EQ(triangles_of(imported(triangle_ply("0.000000000000000123456 0 0"), "ply"))[0][0].x,
            0.000000000000000123456F);
  Random random(3573);
  for (int i = 0; i < 2000; ++i) {
    const auto digits = static_cast<int>(1 + random.below(20));
    const std::string text = fmt::format(
        "{:.{}g}", (random.unit() - 0.5) * std::pow(10.0, random.unit() * 16.0 - 8.0), digits);
    const auto mesh = imported(triangle_ply(text + " 5e8 7"), "ply");
    EXPECT_EQ(triangles_of(mesh)[0][0].x, std::strtof(text.c_str(), nullptr)) << text;
  }
}

/// A decimal that is rounded to double first becomes the even one of two floats.
TEST(Ply, AFloatIsRoundedOnce) {
  const auto x = [](const std::string& text) {
    return triangles_of(imported(triangle_ply(text + " 0 0"), "ply"))[0][0].x;
  };
  EXPECT_EQ(x("0.5000000298023223876953125"), 0.5F) << "halfway: to the even one";
  EXPECT_EQ(x("0.50000002980232238769531250000000000000001"), 0x1.000002p-1F);
  EXPECT_EQ(x("0.50000002980232238769531249999999999999999"), 0.5F);
}

/// Doubles that lie in the middle of two floats among them.
TEST(Ply, DoublesAreTheSameInTextAndInBinary) {
  Random random(17);
  const auto drawn = [&] {
    const auto bits = static_cast<std::uint32_t>(random.below(0x4e000000));  // 0 to some 5e8
    const auto value = static_cast<double>(std::bit_cast<float>(bits));
    const auto next = static_cast<double>(std::bit_cast<float>(bits + 1));
    const double middle = 0.5 * (value + next);
    return random.unit() < 0.5 ? middle : middle * (1.0 + 1e-15 * (random.unit() - 0.5));
  };
  for (int i = 0; i < 500; ++i) {
    const double value = drawn();
    const auto rows = [&](const std::string& text) {
      std::vector<PlyRow> rows = corners("double");
      rows[1][0] = {"double", value, text};
      return rows + tetrahedron_faces();
    };
    const std::string declarations = vertices(4, "double") + faces(4);
    if (!(value > 1e-6)) continue;  // a tetrahedron without volume
    const std::uint64_t hash = ply_hash(ply_file(kPlyEncodings[1], declarations, rows("")));
    EXPECT_EQ(ply_hash(ply_file(kPlyEncodings[2], declarations, rows(""))), hash);
    EXPECT_EQ(ply_hash(ply_file("ascii", declarations, rows(""))), hash) << value;
    EXPECT_EQ(ply_hash(ply_file("ascii", declarations, rows(fmt::format("{:.17g}", value)))), hash);
  }
}

TEST(Ply, AMeshWithoutNumbersBeyondTheLimitIsReadWhateverUnusedVerticesHold) {
  const std::string text = ply_file("ascii", vertices(4) + faces(1), {}) +
                           "0 0 0\n1 0 0\n0 1 0\nnan inf 1e30\n3 0 1 2\n";
  EXPECT_EQ(imported(text, "ply").mesh.vertices.size(), 3U);
}

}  // namespace
}  // namespace beambench::scenes
