// SPDX-License-Identifier: Apache-2.0
#include "studies.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace kompono::synthesis {

const plugin::Registry& BuiltRegistry() {
  static const plugin::Registry kRegistry = [] {
    const std::array folders{std::filesystem::path(KOMPONO_BINARY_DIR) / "lib/kompono/plugins"};
    return plugin::Registry::Discover(folders);
  }();
  return kRegistry;
}

Outcome BuildStudy(const std::string& text, const std::string& file) {
  Outcome outcome;
  Parsed<Study> study = ParseStudy(text, file, BuiltRegistry(), {}, &outcome.notes);
  if (!study) {
    outcome.complaints = RenderAll(study.error(), {});
    return outcome;
  }
  Parsed<StudySpace> space = StudySpace::Build(std::move(*study), BuiltRegistry(), &outcome.notes);
  if (space) {
    outcome.space.emplace(std::move(*space));
  } else {
    outcome.complaints = RenderAll(space.error(), {});
  }
  return outcome;
}

std::string PlainStudy(const std::string& letters, const std::string& equivalence) {
  std::string text = fmt::format(
      "kompono = 1\nstudy = \"plain axes\"\nequivalence = \"{}\"\n[motions]\n", equivalence);
  for (std::size_t i = 0; i < letters.size();) {
    std::size_t end = i + 1;
    while (end < letters.size() && std::isdigit(static_cast<unsigned char>(letters[end])) != 0) {
      ++end;
    }
    text += fmt::format("{} = {{ range = [-100, 100] }}\n", letters.substr(i, end - i));
    i = end;
  }
  return text;
}

Space RandomSpace(int features, int alternatives, double density, int window, unsigned seed) {
  Space space;
  const int rule = space.Add(RuleTitle{.name = "random"});
  for (int f = 0; f < features; ++f) {
    Feature feature{.name = fmt::format("f{}", f)};
    for (int a = 0; a < alternatives; ++a) {
      feature.alternatives.push_back({.name = std::to_string(a)});
    }
    space.Add(std::move(feature));
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  for (int f = 0; f < features; ++f) {
    for (int g = f + 1; g < features && g - f <= window; ++g) {
      for (int a = 0; a < alternatives; ++a) {
        for (int b = 0; b < alternatives; ++b) {
          if (uniform(random) < density) space.Forbid({f, a}, {g, b}, rule);
        }
      }
    }
  }
  return space;
}

std::string SourceText(const std::string& file) {
  std::ifstream in(std::filesystem::path(KOMPONO_SOURCE_DIR) / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace kompono::synthesis
