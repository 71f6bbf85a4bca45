// SPDX-License-Identifier: Apache-2.0
#include "formula_place.hpp"

#include <algorithm>
#include <cctype>

namespace kompono::layout {
namespace {

bool StartsCodePoint(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
}

std::size_t BytesOf(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && !StartsCodePoint(text[end])) ++end;
  return end - at;
}

/// How many bytes of the file one code point of the value takes at `at`; nothing of the value is
/// made by the end-of-line backslash of multi-line strings, which is passed over first.
class RawString {
 public:
  RawString(std::string_view raw, std::size_t begin) : raw_(raw), at_(begin) {
    const char quote = At(0);
    literal_ = quote == '\'';
    multi_line_ = At(1) == quote && At(2) == quote;
    at_ += multi_line_ ? 3 : 1;
    if (multi_line_ && At(0) == '\r') ++at_;
    if (multi_line_ && At(0) == '\n') ++at_;
  }

  /// Offset of the next code point of the value; moves on behind it.
  std::size_t Next() {
    SkipLineEnds();
    const std::size_t start = at_;
    if (at_ >= raw_.size()) return start;
    if (literal_ || At(0) != '\\') {
      at_ += BytesOf(raw_, at_);
    } else {
      at_ += At(1) == 'u' ? 6 : At(1) == 'U' ? 10 : At(1) == 'x' ? 4 : 2;
    }
    at_ = std::min(at_, raw_.size());
    return start;
  }

  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  [[nodiscard]] char At(std::size_t ahead) const {
    return at_ + ahead < raw_.size() ? raw_[at_ + ahead] : '\0';
  }

  void SkipLineEnds() {
    while (!literal_ && multi_line_ && At(0) == '\\' &&
           (std::isspace(static_cast<unsigned char>(At(1))) != 0)) {
      ++at_;
      while (at_ < raw_.size() && std::isspace(static_cast<unsigned char>(raw_[at_])) != 0) ++at_;
    }
  }

  std::string_view raw_;
  std::size_t at_;
  bool literal_ = false;
  bool multi_line_ = false;
};

}  // namespace

std::size_t OffsetAt(std::string_view text, int line, int column) {
  std::size_t at = 0;
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return text.size();
    at = end + 1;
  }
  for (int i = 1; i < column && at < text.size() && text[at] != '\n'; ++i) at += BytesOf(text, at);
  return at;
}

FormulaPlace::FormulaPlace(std::string_view text,
                           const toml::source_region& region,
                           std::string_view value)
    : text_(text), value_(value) {
  const std::size_t begin =
      OffsetAt(text, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column));
  const std::size_t end =
      OffsetAt(text, static_cast<int>(region.end.line), static_cast<int>(region.end.column));
  whole_ = SpanOf(text, begin, std::max(begin, end));
  RawString raw(text, begin);
  for (std::size_t i = 0; i < value.size();) {
    const std::size_t bytes = BytesOf(value, i);
    begin_.insert(begin_.end(), bytes, raw.Next());
    end_.insert(end_.end(), bytes, raw.at());
    i += bytes;
  }
  begin_.push_back(raw.at());
}

SourceSpan FormulaPlace::Between(std::size_t begin, std::size_t end) const {
  begin = std::min(begin, value_.size());
  end = std::clamp(end, begin, value_.size());
  return SpanOf(text_, begin_[begin], end > begin ? end_[end - 1] : begin_[begin]);
}

SourceSpan FormulaPlace::InFile(const SourceSpan& span) const {
  if (span.line <= 0) return whole_;
  const std::size_t begin = OffsetAt(value_, span.line, span.column);
  const std::size_t end = OffsetAt(value_, span.line, span.column + std::max(1, span.length));
  return Between(begin, end);
}

SourceSpan FormulaPlace::OfText(std::string_view text) const {
  const std::size_t at = value_.find(text);
  if (at == std::string::npos || value_.find(text, at + 1) != std::string::npos) return whole_;
  return Between(at, at + text.size());
}

SourceSpan FormulaPlace::OfBlock(std::string_view name) const {
  const auto is_word = [this](std::size_t i) {
    return i < value_.size() &&
           (std::isalnum(static_cast<unsigned char>(value_[i])) != 0 || value_[i] == '_');
  };
  for (std::size_t at = value_.find(name); at != std::string::npos;
       at = value_.find(name, at + 1)) {
    const std::size_t colon = value_.find_last_not_of(' ', at == 0 ? 0 : at - 1);
    if (at > 0 && value_[colon] == ':' && !is_word(at + name.size()))
      return Between(colon, at + name.size());
  }
  return whole_;
}

}  // namespace kompono::layout
