// SPDX-License-Identifier: Apache-2.0
#include "vocabulary.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::formula {
namespace {

struct Motion {
  char letter;
  std::string_view meaning;
};

/// ISO 841.
constexpr std::array kMotions{Motion{'X', "translation along X"},
                              Motion{'Y', "translation along Y"},
                              Motion{'Z', "translation along Z"},
                              Motion{'U', "secondary translation parallel to X"},
                              Motion{'V', "secondary translation parallel to Y"},
                              Motion{'W', "secondary translation parallel to Z"},
                              Motion{'P', "tertiary translation parallel to X"},
                              Motion{'Q', "tertiary translation parallel to Y"},
                              Motion{'R', "tertiary translation parallel to Z"},
                              Motion{'A', "rotation about X"},
                              Motion{'B', "rotation about Y"},
                              Motion{'C', "rotation about Z"},
                              Motion{'D', "additional rotation D"},
                              Motion{'E', "additional rotation E"}};

struct Word {
  std::string_view word;
  std::string_view help;
};

constexpr std::string_view kPartHelp = "the workpiece is the word 'part'";
constexpr std::string_view kToolHelp = "the tool or turret is the word 'tool'";
constexpr std::string_view kBaseHelp = "the base is the capital letter O";
constexpr std::string_view kProcessHelp =
    "a process is written with its direction: P_x, P_y or P_z";
constexpr std::string_view kSpindleHelp =
    "a main-motion spindle is a rotation with its orientation: C_h, C_v or C_i";

constexpr std::array kWords{Word{"part", "did you mean 'part'?"},
                            Word{"tool", "did you mean 'tool'?"},
                            Word{"workpiece", kPartHelp},
                            Word{"work", kPartHelp},
                            Word{"blank", kPartHelp},
                            Word{"turret", kToolHelp},
                            Word{"cutter", kToolHelp},
                            Word{"base", kBaseHelp},
                            Word{"frame", kBaseHelp},
                            Word{"process", kProcessHelp},
                            Word{"nozzle", kProcessHelp},
                            Word{"jet", kProcessHelp},
                            Word{"beam", kProcessHelp},
                            Word{"spindle", kSpindleHelp}};

}  // namespace

bool IsDigit(char32_t code) {
  return code >= U'0' && code <= U'9';
}
bool IsLower(char32_t code) {
  return code >= U'a' && code <= U'z';
}
bool IsUpper(char32_t code) {
  return code >= U'A' && code <= U'Z';
}
bool IsLetter(char32_t code) {
  return IsLower(code) || IsUpper(code);
}

bool IsStructural(char32_t code) {
  return code == U'(' || code == U')' || code == U'+' || code == U'|' || code == U'_' ||
         code == U':';
}

bool IsAxisLetter(char32_t code) {
  if (!IsLetter(code)) return false;
  return !MotionOf(static_cast<char>(std::toupper(static_cast<int>(code)))).empty();
}

bool IsDirection(char32_t code) {
  return code == U'x' || code == U'y' || code == U'z';
}

Orientation OrientationOf(char32_t code) {
  switch (code) {
    case U'h':
      return Orientation::kHorizontal;
    case U'v':
      return Orientation::kVertical;
    case U'i':
      return Orientation::kInclined;
    default:
      return Orientation::kNone;
  }
}

char LetterOf(Orientation orientation) {
  switch (orientation) {
    case Orientation::kHorizontal:
      return 'h';
    case Orientation::kVertical:
      return 'v';
    case Orientation::kInclined:
      return 'i';
    case Orientation::kNone:
      break;
  }
  return 0;
}

std::string_view MotionOf(char letter) {
  const auto* found =
      std::find_if(kMotions.begin(), kMotions.end(), [letter](const Motion& motion) {
        return motion.letter == letter;
      });
  return found == kMotions.end() ? std::string_view() : found->meaning;
}

std::string HelpForWord(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  std::vector<std::string> known;
  known.reserve(kWords.size());
  for (const Word& entry : kWords) known.emplace_back(entry.word);
  const std::string nearest = Nearest(lower, known);
  // Three letters are near to too much.
  if (lower.size() < 4 && nearest.size() < 4 && nearest != lower) return "";
  // A motion in front of a word is no part of it.
  if (!nearest.empty() && nearest.front() != lower.front() &&
      IsAxisLetter(static_cast<unsigned char>(lower.front())))
    return "";
  const auto* found = std::find_if(kWords.begin(), kWords.end(), [&nearest](const Word& entry) {
    return entry.word == nearest;
  });
  return found == kWords.end() ? std::string() : std::string(found->help);
}

std::string HelpForLetters(std::string_view letters) {
  if (letters == "o") return std::string(kBaseHelp);
  if (letters == "S" || letters == "s") return std::string(kSpindleHelp);
  if (letters == "T" || letters == "t") return std::string(kToolHelp);
  return "motions are X Y Z, U V W, P Q R (translations) and A B C D E (rotations); capital for a "
         "working, small for a setting motion";
}

}  // namespace kompono::formula
