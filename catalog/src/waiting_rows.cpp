// SPDX-License-Identifier: Apache-2.0
#include "waiting_rows.hpp"

#include <fmt/format.h>

#include <utility>

namespace kompono::catalog {
namespace {

struct Bind {
  Command& command;
  void operator()(std::monostate /*nothing*/) const { command.Null(); }
  void operator()(std::int64_t value) const { command.Integer(value); }
  void operator()(double value) const { command.Real(value); }
  void operator()(std::string_view text) const { command.Text(text); }
  void operator()(const Sha256* digest) const { command.Digest(*digest); }
};

}  // namespace

WaitingRows::WaitingRows(SQLite::Database& db, std::string table, std::size_t columns)
    : db_(db), table_(std::move(table)), columns_(columns) {}

Command& WaitingRows::Insert(std::size_t size) {
  std::unique_ptr<Command>& insert = inserts_.at(size);
  if (!insert) {
    std::string row = "(";
    for (std::size_t i = 0; i < columns_; ++i) row += i == 0 ? "?" : ", ?";
    row += ")";
    // OR FAIL: whoever sees an error rolls all back; SQLite need not be able to undo the statement
    // alone, which would cost a copy of every page.
    std::string sql = fmt::format("INSERT OR FAIL INTO {} VALUES {}", table_, row);
    for (std::size_t i = 1; i < kRowsAtOnce.at(size); ++i) sql += ", " + row;
    insert = std::make_unique<Command>(db_, sql);
  }
  return *insert;
}

void WaitingRows::Write() {
  std::size_t next = 0;
  for (std::size_t size = 0; size < kRowsAtOnce.size(); ++size) {
    const std::size_t cells = kRowsAtOnce.at(size) * columns_;
    while (next + cells <= cells_.size()) {
      Command& insert = Insert(size);
      for (const std::size_t past = next + cells; next < past; ++next)
        std::visit(Bind{insert}, cells_[next]);
      insert.Run();
    }
  }
  cells_.clear();
}

}  // namespace kompono::catalog
