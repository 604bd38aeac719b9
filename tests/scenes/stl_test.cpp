#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/scenes/imported.hpp"
#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/put.hpp"

namespace beambench::scenes {
namespace {

std::uint64_t stl_hash(const std::string& bytes) { return imported_hash(bytes, "stl"); }

std::string stl_refusal(const std::string& bytes) { return refusal(bytes, "stl"); }

std::string facet(const std::string& loop) {
  return "facet normal 0 0 1\nouter loop\n" + loop + "endloop\nendfacet\n";
}

std::string one_facet(const std::string& first = "0 0 0") {
  return "solid a\n" + facet(fmt::format("vertex {}\nvertex 1 0 0\nvertex 0 1 0\n", first)) +
         "endsolid a\n";
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string with_all(const std::string& text, char old, std::string_view by) {
  std::string result;
  for (const char c : text) {
    if (c == old) {
      result += by;
    } else {
      result += c;
    }
  }
  return result;
}

TEST(Stl, IsTheSameMeshAsTextAndInBinary) {
  EXPECT_EQ(stl_hash(tetrahedron_stl()), tetrahedron_hash());
  EXPECT_EQ(stl_hash(tetrahedron_binary_stl()), tetrahedron_hash());
  EXPECT_EQ(imported(tetrahedron_binary_stl(), "stl").mesh.vertices.size(), 4U);
}

TEST(Stl, TextIsReadInAnyCaseAndLayout) {
  const std::string text = tetrahedron_stl();
  for (const std::string& same :
       {upper_case(text), "\xEF\xBB\xBF" + text, "\n \n" + text, with_all(text, '\n', "\r\n"),
        with_all(text, '\n', "\r"), with_all(text, ' ', "\t  "), with_all(text, ' ', "\n"),
        text.substr(0, text.size() - 1), text + "\n \n"}) {
    if (same.find("\ntest") != std::string::npos) continue;  // a name ends with its line
    EXPECT_EQ(stl_hash(same), tetrahedron_hash()) << same;
  }
  EXPECT_EQ(stl_hash(with_count(text, "facet normal 0 0 0\nouter loop\nvertex",
                                "facet normal 0 0 0 outer loop vertex")),
            tetrahedron_hash());
}

TEST(Stl, NamesAreAnyTextOrMissing) {
  const std::string text = tetrahedron_stl();
  for (const char* name : {"", " ", " a name with blanks", " facet normal 0 0 0", " 1 2 3"}) {
    EXPECT_EQ(stl_hash(with_count(with_count(text, "endsolid test", std::string("endsolid") + name),
                                  "solid test", std::string("solid") + name)),
              tetrahedron_hash())
        << name;
  }
}

TEST(Stl, SolidsOfAFileAreOneMesh) {
  const std::string text =
      with_count(tetrahedron_stl(), "endfacet\n", "endfacet\nendsolid test\n\nsolid other one\n");
  EXPECT_EQ(stl_hash(text + "solid none\nendsolid\n"), tetrahedron_hash());
}

TEST(Stl, NormalsAreNotRead) {
  for (const char* normal : {"nan nan nan", "1.#QNAN 0 0", "1e999 0 0"}) {
    EXPECT_EQ(
        stl_hash(with_count(tetrahedron_stl(), "normal 0 0 0", std::string("normal ") + normal)),
        tetrahedron_hash());
  }
}

TEST(Stl, ABinaryFileMayBeginWithSolid) {
  std::string bytes = tetrahedron_binary_stl();
  for (const char* header : {"solid test\nfacet normal 0 0 0\n", "SOLID", "solid\0"}) {
    std::string_view text(header);
    EXPECT_EQ(stl_hash(bytes.replace(0, text.size(), text)), tetrahedron_hash());
  }
}

TEST(Stl, AttributesOfFacetsAreSkipped) {
  std::string bytes = tetrahedron_binary_stl();
  for (std::size_t end = 84 + 50; end <= bytes.size(); end += 50)
    bytes.replace(end - 2, 2, "\xff\x7f");
  EXPECT_EQ(stl_hash(bytes), tetrahedron_hash());
}

/// numpy-stl issue 37: half of the loop was lost.
TEST(Stl, ALoopWithoutThreeVerticesIsRefused) {
  const auto solid = [](const std::string& loop) { return "solid\n" + facet(loop) + "endsolid\n"; };
  EXPECT_TRUE(says(stl_refusal(solid("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n")),
                   {"a.stl: line 7: ", "more than three vertices", "triangles"}));
  EXPECT_TRUE(says(stl_refusal(solid("vertex 0 0 0\nvertex 1 0 0\n")),
                   {"a.stl: line 6: ", "found 'endloop' where 'vertex' must be"}));
}

TEST(Stl, AnInvalidNumberIsRefusedWithItsLine) {
  for (const char* word : {"1.#QNAN", "1,5", "x", "1e", "0x1"}) {
    EXPECT_TRUE(says(stl_refusal(one_facet(fmt::format("0 {} 0", word))),
                     {"a.stl: line 4: ", fmt::format("found '{}' where", word), "number"}));
  }
  EXPECT_TRUE(says(stl_refusal(one_facet("0 0")), {"line 5: ", "found 'vertex' where", "number"}));
  EXPECT_TRUE(says(stl_refusal(one_facet("0 0 0 0")), {"line 4: ", "found '0' where 'vertex'"}));
  EXPECT_TRUE(says(stl_refusal(one_facet("nan 0 0")), {"coordinate nan", "1e9"}));
}

TEST(Stl, WordsOutOfPlaceAreRefusedWithTheirLine) {
  for (const auto& [old, by] :
       std::vector<std::pair<std::string, std::string>>{{"facet normal", "facet norm"},
                                                        {"normal 0 0 1", "normal 0 1"},
                                                        {"normal 0 0 1", "normal 0 0 1 1"},
                                                        {"outer", "inner"},
                                                        {"endloop", "end"},
                                                        {"endfacet", "endloop"},
                                                        {"endsolid", "endsolids"},
                                                        {"endsolid", "color 1 0 0\nendsolid"},
                                                        {"facet", "polygon"}}) {
    EXPECT_TRUE(says(stl_refusal(with_count(one_facet(), old, by)),
                     {"a.stl: line ", ": found '", "' must be"}))
        << by;
  }
  EXPECT_TRUE(says(stl_refusal(one_facet() + "more"), {"line 10: found 'more' where 'solid'"}));
}

TEST(Stl, ATextTruncatedAnywhereIsRefused) {
  const std::string text = one_facet();
  const std::size_t end = text.find("endsolid") + std::string("endsolid").size();
  for (std::size_t size = 0; size < end; ++size) {
    EXPECT_NE(stl_refusal(text.substr(0, size)), "(nothing thrown)") << size;
  }
}

TEST(Stl, ABinaryFileOfAnotherLengthIsRefused) {
  const std::string bytes = tetrahedron_binary_stl();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(stl_refusal(bytes.substr(0, size)), "(nothing thrown)") << size;
  }
  EXPECT_TRUE(says(stl_refusal(bytes + "\n"), {"a.stl: ", "number of its facets, 4,", "284 bytes",
                                               "has 285", "export it again"}));
  EXPECT_TRUE(says(stl_refusal("solid" + bytes.substr(5) + "\n"), {"284 bytes", "has 285"}));
}

TEST(Stl, AFileWithoutFacetsIsRefusedWithItsOwnMessage) {
  std::string bytes(80, ' ');
  tests::put(bytes, std::uint32_t{0});
  for (const std::string& none : {bytes, std::string("solid a\nendsolid a\n")}) {
    EXPECT_TRUE(says(stl_refusal(none), {"a.stl: ", "no triangle is in it", "no faces at all"}));
  }
  EXPECT_TRUE(says(stl_refusal("These are no triangles."), {"a.stl: ", "not an STL", "'solid'"}));
}

TEST(Stl, FacetsWithoutAreaAreLeftOutAndCounted) {
  const auto mesh = imported(
      "solid\n" + facet("vertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\n") + one_facet().substr(8),
      "stl");
  EXPECT_EQ(mesh.mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"1 triangles without area", "triangle 0"}));
}

TEST(Stl, CoordinatesAreRoundedOnce) {
  const auto x = [](const std::string& text) {
    return triangles_of(imported(one_facet(text + " 0 0"), "stl"))[0][0].x;
  };
  EXPECT_EQ(x("0.000000000000000123456"), 0.000000000000000123456F);
  EXPECT_EQ(x("0.50000002980232238769531250000000000000001"), 0x1.000002p-1F);
}

}  // namespace
}  // namespace beambench::scenes
