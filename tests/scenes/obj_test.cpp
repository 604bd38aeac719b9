#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>

#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

namespace fs = std::filesystem;
using mesh::ImportedMesh;

constexpr const char* kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class Obj : public testing::Test {
 protected:
  ImportedMesh read(const std::string& text) const {
    return mesh::import_mesh(text, "obj", folder_.write("a.obj", text));
  }
  std::string message(const std::string& text) const {
    return thrown_message([&] { read(text); });
  }

  TemporaryFolder folder_;
};

glm::vec3 corner(const ImportedMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.mesh.vertices[mesh.mesh.triangles[triangle][i]];
}

double area_of(const ImportedMesh& mesh) {
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
    const glm::dvec3 a(corner(mesh, i, 0));
    area += 0.5 * glm::length(glm::cross(glm::dvec3(corner(mesh, i, 1)) - a,
                                         glm::dvec3(corner(mesh, i, 2)) - a));
  }
  return area;
}

/// Returns any number that a scene can hold, drawn by its bits.
float drawn_float(Random& random) {
  for (;;) {
    const auto number = std::bit_cast<float>(static_cast<std::uint32_t>(random.below(1ULL << 32U)));
    if (std::abs(number) <= 1e9F && std::abs(number) > 1e-37F) return number;
  }
}

TEST_F(Obj, NumbersAreExactHoweverTheyAreWritten) {
  Random random(7);
  std::string text;
  std::vector<float> expected;
  for (int i = 0; i < 3000; ++i) {
    text += "v";
    for (int axis = 0; axis < 3; ++axis) {
      const float number = drawn_float(random);
      expected.push_back(number);
      switch (random.below(4)) {
        case 0:
          text += fmt::format(" {:.9g}", number);
          break;
        case 1:
          text += fmt::format(" {}", number);
          break;
        case 2:
          text += fmt::format(" {}", double{number});
          break;
        default:
          text += fmt::format(" {:.17g}", double{number});
      }
    }
    text += i % 3 == 2 ? "\nf -3 -2 -1\n" : "\n";
  }
  const ImportedMesh mesh = read(text);
  ASSERT_GT(mesh.mesh.triangles.size(), 900U);
  std::size_t place = 0;
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
    // Triangles without area, if any, are left out.
    const auto same = [&] { return corner(mesh, i, 0).x == expected[place]; };
    while (!same()) place += 9;
    for (std::size_t j = 0; j < 9; ++j) {
      EXPECT_EQ(corner(mesh, i, j / 3)[static_cast<int>(j % 3)], expected[place + j]);
    }
    place += 9;
  }
}

/// Uses stars with corners at rising angles and arbitrary distances, so that they may be concave.
RC_GTEST_FIXTURE_PROP(Obj, ConcavePolygonsKeepTheirArea, ()) {
  const int count = *rc::gen::inRange(4, 14);
  std::string text;
  std::string face = "f";
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 6.28318530717958648 * i / count;
    const double radius = 0.1 * *rc::gen::inRange(2, 40);
    const glm::vec3 place(glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), 0.0));
    corners.emplace_back(place);
    text += fmt::format("v {} {} {}\n", place.x, place.y, place.z);
    face += fmt::format(" {}", i + 1);
  }
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    area += 0.5 * glm::cross(corners[i], corners[(i + 1) % corners.size()]).z;
  }
  RC_ASSERT(std::abs(area_of(read(text + face + "\n")) - area) < 1e-5 * area);
}

TEST_F(Obj, FacesReferToVerticesInEveryForm) {
  for (const char* face : {"f 1 2 3", "f -3 -2 -1", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1",
                           "f 1/1/1 2/1/1 3/1/1", "  f\t1  2\t3  ", "f 1 \\\n2 3", "f +1 2 3"}) {
    const ImportedMesh mesh = read(fmt::format("{}vt 0 0\nvn 0 0 1\n{}\n", kThreeVertices, face));
    ASSERT_EQ(mesh.mesh.triangles.size(), 1U) << face;
    EXPECT_EQ(corner(mesh, 0, 2), glm::vec3(0.0F, 1.0F, 0.0F)) << face;
  }
  EXPECT_EQ(read(fmt::format("f 1 2 3\n{}", kThreeVertices)).mesh.triangles.size(), 1U)
      << "a vertex may come later";
  EXPECT_EQ(read("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n").mesh.triangles.size(), 1U);
  EXPECT_EQ(corner(read("v 1e-999 0 0\nv +1 0 0\nv 0 1. 0\nf 1 2 3"), 0, 0), glm::vec3(0.0F));
  EXPECT_EQ(corner(read("v 1e-40 0 0\nv +1 0 0\nv 0 1. 0\nf 1 2 3"), 0, 0).x, 1e-40F);
  EXPECT_EQ(
      read("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0 1 0 0 nan\nf 1/ 2// 3//0\n").mesh.triangles.size(),
      1U)
      << "weights and colors";
  EXPECT_EQ(read("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3").mesh.triangles.size(), 1U);
}

TEST_F(Obj, ARefusalStatesThePlace) {
  const auto refused = [&](const std::string& lines,
                           std::initializer_list<std::string_view> words) {
    EXPECT_TRUE(says(message(kThreeVertices + lines), words)) << lines;
    EXPECT_TRUE(says(message(kThreeVertices + lines), {"a.obj: "}));
  };
  refused("f 1 2 4\n", {"line 4", "refers to vertex 4", "3 vertices"});
  refused("f 1 2 3\n\nf 1 2 -4\n", {"line 6", "refers to vertex -4", "3 vertices"});
  refused("f 1 2 -2147483648\n", {"line 4", "refers to vertex -2147483648"});
  refused("f 1 2 2147483647\n", {"line 4", "refers to vertex 2147483647"});
  refused("f 1 2 3\nf\nf 1 \\\n2 3 9\n", {"line 6", "refers to vertex 9"});
  refused("f 0 1 2\n", {"line 4", "'0'", "count from 1"});
  refused("f 1 2 x\n", {"line 4", "the corner 'x'"});
  refused("f 1 2 4294967299\n", {"line 4", "'4294967299'"});
  refused("v 1 2\n", {"line 4", "fewer than three coordinates"});
  refused("v 1 2 three\n", {"line 4", "'three'", "must have numbers"});
  refused("v 1 2 1e999\nf 1 2 3\n", {"line 4", "'1e999'"});
  refused("v 1 2 1,5\n", {"line 4", "'1,5'"});
  refused("v 1 2 3 v 4 5 6\n", {"line 4", "'v'"});
  refused("v 1 2 3 4 5 6 7 8\n", {"line 4", "8 numbers"});
  refused("f 1/2/3/4 2 3\n", {"line 4", "'1/2/3/4'"});
  refused("f 1/x 2 3\n", {"line 4", "'1/x'"});
  refused("f 1 \\\n2 3\nv nan 0 0\n", {"line 6", "'nan'"});
}

// Lines that are not understood

TEST_F(Obj, LinesThatAreNotUnderstoodAreCountedWithTheirNumbers) {
  const std::string text = std::string(kThreeVertices) + "f 1 2 3\n";
  const auto warning_for = [&](const std::string& line) {
    const ImportedMesh mesh = read(text + line + "\nf 3 2 1\n");
    EXPECT_EQ(mesh.mesh.triangles.size(), 2U) << line;
    return mesh.warnings.size() == 1 ? mesh.warnings[0] : std::string("(not one warning)");
  };
  EXPECT_EQ(warning_for("V 0 0 1"), "1 line is not understood and was left out: line 5 ('V')");
  EXPECT_TRUE(says(warning_for("F 1 2 3"), {"line 5 ('F')"}));
  EXPECT_TRUE(says(warning_for("v\xC2\xA0"
                               "0 0 1"),
                   {"line 5 ('v\xC2\xA0"
                    "0')"}));
  EXPECT_TRUE(says(warning_for(std::string(4096, '\0') + "v 0 0 1"), {"line 5 ('\\x00\\x00"}));
  EXPECT_TRUE(says(warning_for("f"), {"line 5 ('f')"})) << "a face without corners";
  EXPECT_TRUE(says(warning_for("call other.obj"), {"line 5 ('call')"}));
  EXPECT_TRUE(says(warning_for("\xEF\xBB\xBFv 0 0 1"), {"line 5 ('"}))
      << "a byte order mark in the middle";
  EXPECT_EQ(warning_for("a\nb\nc\nd \\\ne"),
            "5 lines are not understood and were left out: line 5 ('a'), line 6 ('b'), "
            "line 7 ('c') and 2 more");
}

TEST_F(Obj, AnUnintelligibleFileIsRefusedWithItsLines) {
  EXPECT_TRUE(
      says(message("hello\nworld\n"), {"a.obj: ", "no face", "2 lines", "line 1 ('hello')"}));
}

TEST_F(Obj, StatementsIrrelevantToRaysAreUnderstood) {
  const std::string text =
      std::string("# a comment\n\n \t\no name\ng one two\ng\ns off\ns 1\nmg 1 0.5\nbevel on\n") +
      "c_interp off\nd_interp off\nlod 3\nmaplib a.map\nusemap off\nshadow_obj a.obj\n"
      "trace_obj a.obj\nvn 0 0 nan\nvt 0 0\nvp 0 0\n" +
      kThreeVertices + "f 1 2 3\n";
  EXPECT_TRUE(read(text).warnings.empty());
  const std::string free_forms =
      "cstype rat bspline\ndeg 2 2\nbmat u 1 0 \\\n0 1\nstep 1 1\nsurf 0 1 0 1 1 2 3\n"
      "parm u 0 1\nparm v 0 1\ntrim 0 1 1\nhole 0 1 1\nscrv 0 1 1\nsp 1\nctech cparm 1\n"
      "stech cparma 1 1\nend\ncon 1 0 1 1 2 0 1 1\nres 2 2\nbzp 1 2 3\n";
  EXPECT_EQ(read(text + free_forms).warnings,
            std::vector<std::string>{"2 free-form curves and surfaces were left out"});
}

TEST_F(Obj, AByteOrderMarkIsSkipped) {
  const ImportedMesh mesh = read("\xEF\xBB\xBF" + std::string(kThreeVertices) + "f 1 2 3\n");
  EXPECT_TRUE(mesh.warnings.empty());
  EXPECT_EQ(corner(mesh, 0, 0), glm::vec3(0.0F)) << "the first vertex";
  EXPECT_EQ(corner(mesh, 0, 1), glm::vec3(1.0F, 0.0F, 0.0F));
  folder_.write("a.mtl", "\xEF\xBB\xBFnewmtl red\nKd 1 0 0\n");
  EXPECT_EQ(read("mtllib a.mtl\n" + std::string(kThreeVertices) + "usemtl red\nf 1 2 3\n")
                .mesh.parts.at(0)
                .surface.color,
            glm::vec3(1.0F, 0.0F, 0.0F));
}

TEST_F(Obj, Utf16IsIdentified) {
  const std::string text = std::string(kThreeVertices) + "f 1 2 3\n";
  const auto wide = [&](bool low_first) {
    std::string bytes;
    for (const char c : text) bytes += low_first ? std::string{c, '\0'} : std::string{'\0', c};
    return bytes;
  };
  for (const std::string& bytes :
       {"\xFF\xFE" + wide(true), "\xFE\xFF" + wide(false), wide(true), wide(false)}) {
    EXPECT_TRUE(says(message(bytes), {"a.obj: ", "UTF-16", "save it as UTF-8"}));
  }
  folder_.write("a.mtl", "\xFF\xFEn");
  const ImportedMesh mesh = read("mtllib a.mtl\n" + text);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"its materials were left out", "a.mtl", "UTF-16"}));
}

TEST_F(Obj, CommentsMayFollowNumbers) {
  const ImportedMesh mesh = read(
      "v 0 0 0 # origin\nv 1 0 0#x\nv 0 1 0 #\nv 0 0 1 # 5 6 7\n"
      "f 1 2 3 # 4 \\\nf 2 3 4 # comment\nf 1 3 4\n");
  EXPECT_EQ(mesh.mesh.triangles.size(), 3U);
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(Obj, OnlyStatementsOfNumbersContinueOnTheNextLine) {
  for (const char* line : {"# a comment \\", "g C:\\", "o name\\", "usemtl a\\", "mtllib \\",
                           "f 1 2 3 # C:\\", "unknown \\"}) {
    const std::string text = fmt::format("{}{}\nf 1 2 3\r\n", kThreeVertices, line);
    EXPECT_EQ(read(text).mesh.triangles.size(), line[0] == 'f' ? 2U : 1U) << line;
  }
  for (const char* face :
       {"f 1 \\\r\n2 \\\r\n3", "f\\\n 1 2 3", "f \\\r1 2 3", "f 1 2 3 \\", "f 1 2\\\n3"}) {
    const ImportedMesh mesh = read(fmt::format("{}{}", kThreeVertices, face));
    EXPECT_EQ(mesh.mesh.triangles.size(), 1U) << face;
    EXPECT_TRUE(mesh.warnings.empty()) << face;
  }
}

TEST_F(Obj, FaceOutlinesOfOldFilesAreFaces) {
  EXPECT_EQ(read(std::string(kThreeVertices) + "fo 1 2 3\n").mesh.triangles.size(), 1U);
}

TEST_F(Obj, ElementsOtherThanFacesAreCounted) {
  const ImportedMesh mesh =
      read(fmt::format("{}f 1 2 3\nf 1 2\np 1\nl 1 2 3\ncurv 0 1 1 2\n", kThreeVertices));
  ASSERT_EQ(mesh.warnings.size(), 2U);
  EXPECT_EQ(mesh.warnings[0], "3 points and lines were left out");
  EXPECT_EQ(mesh.warnings[1], "1 free-form curves and surfaces were left out");
}

TEST_F(Obj, MaterialsAreThoseOfItsLibraries) {
  folder_.write("two words.mtl",
                "newmtl  dark red \nKd 0.5 0 0\nnewmtl plain\nnewmtl painted\n"
                "Kd 0 0 0\nmap_Kd a.png\n");
  folder_.write("b.mtl", "newmtl blue\r\nKd 0 0 1\r\nTr 0.25\r\n");
  folder_.write("c.mtl", "newmtl green\nKd 0 1 0\n");
  std::string text = std::string("mtllib two words.mtl\nmtllib b.mtl c.mtl\n") + kThreeVertices;
  for (const char* name : {"dark red", "blue", "green", "plain", "painted", "unknown"}) {
    text += fmt::format("usemtl {}\nf 1 2 3\n", name);
  }
  const ImportedMesh mesh = read(text);
  ASSERT_EQ(mesh.mesh.parts.size(), 6U);
  EXPECT_EQ(mesh.mesh.parts[0].surface.color, glm::vec3(0.5F, 0.0F, 0.0F));
  EXPECT_EQ(mesh.mesh.parts[1].surface.color, glm::vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(mesh.mesh.parts[1].surface.transmittance, 0.25F);
  EXPECT_EQ(mesh.mesh.parts[2].surface.color, glm::vec3(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(mesh.mesh.parts[3].surface.color, glm::vec3(0.6F)) << "the material has no color";
  EXPECT_EQ(mesh.mesh.parts[4].surface.color, glm::vec3(0.5F)) << "the material has a texture";
  EXPECT_EQ(mesh.companions.size(), 4U) << "three files, and 'b.mtl c.mtl', which does not exist";
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(Obj, MaterialsMayHaveCommentsAndFewerNumbers) {
  folder_.write("a.mtl",
                "newmtl red # the first\nKd 1 0 0 # red\nd -halo 0.75\rnewmtl gray\nKd 0.5\n"
                "newmtl with#number\nKd 0 1 0\n");
  std::string text = std::string("mtllib a.mtl # colors\n") + kThreeVertices;
  for (const char* name : {"red", "gray # not red", "with#number"}) {
    text += fmt::format("usemtl {}\nf 1 2 3\n", name);
  }
  const ImportedMesh mesh = read(text);
  EXPECT_TRUE(mesh.warnings.empty());
  ASSERT_EQ(mesh.mesh.parts.size(), 3U);
  EXPECT_EQ(mesh.mesh.parts[0].surface.color, glm::vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(mesh.mesh.parts[0].surface.transmittance, 0.25F);
  EXPECT_EQ(mesh.mesh.parts[1].surface.color, glm::vec3(0.5F));
  EXPECT_EQ(mesh.mesh.parts[2].surface.color, glm::vec3(0.0F, 1.0F, 0.0F));
}

TEST_F(Obj, LinesOfMaterialsThatAreNotUnderstoodAreCounted) {
  folder_.write("a.mtl", "newmtl m\nKd 1 zero 0\nKd spectral a.rfl\nd\nTr x\nKs x\nnewmtl\n");
  const ImportedMesh mesh =
      read("mtllib a.mtl\n" + std::string(kThreeVertices) + "usemtl m\nf 1 2 3\n");
  EXPECT_EQ(mesh.mesh.parts.at(0).surface.color, glm::vec3(0.6F));
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_EQ(mesh.warnings[0],
            "a.mtl: 5 lines are not understood and were left out: line 2 ('Kd'), line 3 ('Kd'), "
            "line 4 ('d') and 2 more");
}

TEST_F(Obj, ExponentsMayBeLong) {
  const ImportedMesh tiny = read(
      "v 1e-2147483648 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 .5E+2147483649\nvt 1.e9999999999\nf 1 2 3\n");
  EXPECT_EQ(corner(tiny, 0, 0), glm::vec3(0.0F));
  EXPECT_TRUE(says(message(kThreeVertices + std::string("v 1e2147483649 0 0\nf 1 2 3\n")),
                   {"line 4", "'1e2147483649'"}));
  EXPECT_EQ(
      read("o a1e2147483649\n" + std::string(kThreeVertices) + "f 1 2 3\n").mesh.triangles.size(),
      1U);
  folder_.write("a.mtl", "newmtl 1e2147483649\nKs .5e-2147483648 0 0\nKd 1 0 0\n");
  const ImportedMesh mesh =
      read("mtllib a.mtl\n" + std::string(kThreeVertices) + "usemtl 1e2147483649\nf 1 2 3\n");
  EXPECT_EQ(mesh.mesh.parts.at(0).surface.color, glm::vec3(1.0F, 0.0F, 0.0F));
}

TEST_F(Obj, LibrariesOutsideOfItsFolderAreNotRead) {
  fs::create_directory(folder_.path() / "in");
  const fs::path secret = folder_.write("out.mtl", "newmtl m\nKd 1 0 0\n");
  fs::create_symlink(secret, folder_.path() / "in" / "link.mtl");
  fs::create_directory_symlink("..", folder_.path() / "in" / "up");
  for (const std::string& library :
       {std::string("../out.mtl"), std::string("link.mtl"), std::string("x/../../out.mtl"),
        std::string("up/out.mtl"), secret.string()}) {
    const std::string text =
        fmt::format("mtllib {}\n{}usemtl m\nf 1 2 3\n", library, kThreeVertices);
    const ImportedMesh mesh = mesh::import_mesh(text, "obj", folder_.write("in/a.obj", text));
    EXPECT_NE(mesh.mesh.parts[0].surface.color, glm::vec3(1.0F, 0.0F, 0.0F)) << library;
    ASSERT_EQ(mesh.warnings.size(), 1U);
    EXPECT_TRUE(
        says(mesh.warnings[0], {"its materials were left out", library, "not in its folder"}));
  }
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe.mtl").c_str(), 0600), 0);
  for (const std::string& library :
       {std::string("pipe.mtl"), "file://" + secret.string(), std::string("%2e%2e/out.mtl")}) {
    const ImportedMesh mesh =
        read(fmt::format("mtllib {}\n{}usemtl m\nf 1 2 3\n", library, kThreeVertices));
    EXPECT_NE(mesh.mesh.parts[0].surface.color, glm::vec3(1.0F, 0.0F, 0.0F)) << library;
    ASSERT_EQ(mesh.warnings.size(), 1U);
    EXPECT_TRUE(says(mesh.warnings[0], {"its materials were left out"})) << library;
  }
  const ImportedMesh mesh = read(fmt::format("mtllib none.mtl\n{}f 1 2 3\n", kThreeVertices));
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"its materials were left out", "none.mtl", "No such file"}));
}

/// Reads in this process, so that a sanitizer detects faults.
TEST_F(Obj, ADamagedFileIsReadOrRefused) {
  folder_.write("m.mtl", "newmtl m\nKd 1 0 0\n");
  const std::string whole = "mtllib m.mtl\no name\ng a b\n" + tetrahedron_obj() +
                            "usemtl m\nf 1/1/1 2/2/2 3/3/3 4\nf -1 -2 -3\nl 1 2\nvt 0 1\n";
  const fs::path path = folder_.write("a.obj", whole);
  Random random(2026);
  for (int i = 0; i < 4000; ++i) {
    std::string damaged = whole;
    if (random.unit() < 0.3) damaged.resize(1 + random.below(whole.size() - 1));
    for (auto changes = random.below(4); changes > 0; --changes) {
      constexpr std::string_view kLikely = "0123456789 -/.e\n\\vfl";
      char& c = damaged[random.below(damaged.size())];
      c = random.unit() < 0.5 ? kLikely[random.below(kLikely.size())]
                              : static_cast<char>(random.below(256));
    }
    SCOPED_TRACE(damaged);
    try {
      EXPECT_FALSE(mesh::import_mesh(damaged, "obj", path).mesh.triangles.empty());
    } catch (const InputError& error) {
      EXPECT_TRUE(says(error.what(), {"a.obj"}));
    }
  }
}

}  // namespace
}  // namespace beambench::scenes
