// SPDX-License-Identifier: Apache-2.0
// docs/gallery.md shows every machine of layouts/machines, and the pictures are those that are
// drawn today. KOMPONO_UPDATE_PICTURES=1 writes page and pictures anew.
#include "shipped_machines.hpp"

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "kompono/exporting/drawing.hpp"

namespace kompono::exporting {
namespace {

namespace fs = std::filesystem;

const fs::path kDocs = fs::path(KOMPONO_SOURCE_DIR) / "docs";

bool Updating() {
  return std::getenv("KOMPONO_UPDATE_PICTURES") != nullptr;
}

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

fs::path PictureOf(const std::string& name) {
  return kDocs / "pictures" / (name + ".svg");
}

/// Equal texts but for the last digit of a coordinate, which is the compiler's.
testing::AssertionResult SamePicture(const std::string& got, const std::string& kept) {
  const auto begins_number = [](const std::string& text, std::size_t at) {
    return std::isdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  std::size_t i = 0;
  std::size_t k = 0;
  while (i < got.size() && k < kept.size()) {
    if (begins_number(got, i) && begins_number(kept, k)) {
      char* got_end = nullptr;
      char* kept_end = nullptr;
      const double one = std::strtod(got.c_str() + i, &got_end);
      const double other = std::strtod(kept.c_str() + k, &kept_end);
      if (std::abs(one - other) > 0.15)
        return testing::AssertionFailure() << one << " instead of " << other << " at byte " << k;
      i = static_cast<std::size_t>(got_end - got.c_str());
      k = static_cast<std::size_t>(kept_end - kept.c_str());
    } else if (got[i] != kept[k]) {
      return testing::AssertionFailure()
             << "'" << got.substr(i, 40) << "' instead of '" << kept.substr(k, 40) << "'";
    } else {
      ++i;
      ++k;
    }
  }
  if (i == got.size() && k == kept.size()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "one picture ends before the other";
}

std::string Page() {
  std::string page =
      "# Gallery\n\n"
      "Every machine in [layouts/machines](../layouts/machines), drawn at its home pose by "
      "`kompono export FILE --to svg` from the skeletons "
      "that the\nmechanisms compute with: rails grey, struts blue (pods with a thicker cylinder), "
      "platforms orange, parts green, tools with a "
      "red tip. This page and\nits pictures are written by `KOMPONO_UPDATE_PICTURES=1 "
      "build/release/tests/gallery_test`; a test says when "
      "one of them is missing or old.\n";
  for (const std::string& name : tests::ShippedMachineFiles()) {
    const layout::Layout layout = tests::LoadMachine(name).layout();
    page += "\n## " + layout.name + "\n![" + layout.name + "](pictures/" + name + ".svg)\n\n`" +
            formula::Canonical(layout.formula) + "`\n\n" + layout.description + " File: [" + name +
            ".toml](../layouts/machines/" + name + ".toml)\n";
  }
  return page;
}

class Picture : public testing::TestWithParam<std::string> {};

TEST_P(Picture, IsTheOneDrawnToday) {
  const kinematics::Machine machine = tests::LoadMachine(GetParam());
  const std::string svg = DrawSvg(machine, machine.home(), machine.nominal());
  if (Updating()) std::ofstream(PictureOf(GetParam()), std::ios::binary) << svg;
  EXPECT_TRUE(SamePicture(svg, Bytes(PictureOf(GetParam()))))
      << "KOMPONO_UPDATE_PICTURES=1 gallery_test writes it anew";
}

TEST_P(Picture, OfALayoutThatSaysWhatItIs) {
  const layout::Layout layout = tests::LoadMachine(GetParam()).layout();
  EXPECT_NE(layout.name, "");
  EXPECT_THAT(layout.description, testing::EndsWith("."));
}

INSTANTIATE_TEST_SUITE_P(Shipped,
                         Picture,
                         testing::ValuesIn(tests::ShippedMachineFiles()),
                         [](const auto& machine) { return machine.param; });

TEST(Gallery, ShowsEveryMachine) {
  const std::string page = Page();
  if (Updating()) std::ofstream(kDocs / "gallery.md", std::ios::binary) << page;
  EXPECT_EQ(Bytes(kDocs / "gallery.md"), page)
      << "KOMPONO_UPDATE_PICTURES=1 gallery_test writes it anew";
}

TEST(Gallery, HasNoPictureOfAMachineThatIsGone) {
  const std::vector<std::string> names = tests::ShippedMachineFiles();
  for (const auto& entry : fs::directory_iterator(kDocs / "pictures"))
    EXPECT_THAT(names, testing::Contains(entry.path().stem().string()));
}

TEST(Gallery, ComparisonNoticesWhatMoved) {
  EXPECT_TRUE(SamePicture("<line x1=\"10.1\"/>", "<line x1=\"10.2\"/>"));
  EXPECT_FALSE(SamePicture("<line x1=\"10.1\"/>", "<line x1=\"10.4\"/>"));
  EXPECT_FALSE(SamePicture("<line class=\"rail\"/>", "<line class=\"strut\"/>"));
  EXPECT_FALSE(SamePicture("<line/>", "<line/><line/>"));
}

}  // namespace
}  // namespace kompono::exporting
