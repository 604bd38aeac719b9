#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/ply_file.hpp"
#include "tests/scenes/imported.hpp"
#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/ply_parts.hpp"

namespace beambench::scenes {
namespace {

using namespace ply_parts;
using tests::kPlyEncodings;

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
TEST(Ply, OtherElementsAndPropertiesAreSkippedAnywhere) {
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
TEST(Ply, AFaceWithoutVerticesIsIgnored) {
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

TEST(Ply, PolygonsAreTriangulatedAsInObjFiles) {
  const std::string places = "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n";
  const std::string ply =
      ply_file("ascii", vertices(5) + faces(2), {}) + places + "5 0 1 2 3 4\n4 3 2 1 0\n";
  const std::string obj = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\nf 4 3 2 1\n";
  EXPECT_EQ(ply_hash(ply), imported_hash(obj, "obj"));
}

// The header

/// Assimp issues 4866 and 819: z was 0, or the file was refused.
TEST(Ply, CommentsAndBlanksMayAppearAnywhereInTheHeader) {
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

TEST(Ply, TheFormatMayAppearAnywhereInTheHeader) {
  const std::string text = tetrahedron_ply();
  const std::string format = "format ascii 1.0\n";
  const std::string without = with_count(text, format, "");
  EXPECT_EQ(ply_hash(with_count(without, "end_header\n", format + "end_header\n")),
            tetrahedron_hash());
}

/// Assimp issue 4755: bytes that look like a line end were removed from the data.
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
      {"vertex 4", "vertex 99999999999999999999", {"line 4: ", "not a number of rows"}},
      {"float x", "real x", {"line 5: ", "'real' is not a property type"}},
      {"float x", "float", {"line 5: ", "no name"}},
      {"float x", "float y", {"line 6: ", "'y' is declared twice"}},
      {"element face", "element vertex", {"line 8: ", "'vertex' is declared twice"}},
      {"uchar int", "float int", {"line 9: ", "integer type"}},
      {"uchar int", "uchar", {"line 9: ", "'vertex_indices' is not a property type"}},
      {"element vertex 4\n", "", {"line 4: ", "precedes the first element"}},
      {"float z", "float w", {"element 'vertex' without 'z'"}},
      {"float z", "list uchar float z", {"'z' instead of a number"}},
      {"list uchar int vertex_indices",
       "int vertex_indices",
       {"'vertex_indices' that is not a list"}},
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

TEST(Ply, APointCloudIsRefusedWithItsOwnMessage) {
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
                     {"declares 1000000000000000000 of the element 'vertex'", "no properties"}));
  }
}

}  // namespace
}  // namespace beambench::scenes
