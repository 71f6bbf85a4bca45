// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/query.hpp"

#include "expression.hpp"
#include "failure.hpp"
#include "guard.hpp"
#include "metric_terms.hpp"
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include <sqlite3.h>

#include "kompono/diagnostics/suggestion.hpp"

namespace kompono::catalog {
namespace {

/// The statement under construction, and where in it each text of the user went.
class Composition {
 public:
  void Append(std::string_view sql) { sql_ += sql; }

  /// `(` tokens `)`, so that the text stays one operand whatever it is; `terms` of the text are
  /// put into SQL.
  void AppendOperand(const Expression& expression,
                     std::span<const MetricTerms::Term> terms,
                     std::size_t first,
                     std::size_t last) {
    std::size_t begin = expression.tokens[first].begin;
    sql_ += '(';
    for (const MetricTerms::Term& term : terms) {
      if (term.first < first || term.last > last) continue;
      const std::size_t from = expression.tokens[term.first].begin;
      AppendPiece(expression, begin, expression.text.substr(begin, from - begin));
      AppendPiece(expression, from, term.Sql());
      begin = expression.tokens[term.last - 1].end;
    }
    const std::size_t end = expression.tokens[last - 1].end;
    AppendPiece(expression, begin, expression.text.substr(begin, end - begin));
    sql_ += ')';
  }

  [[nodiscard]] const std::string& Sql() const { return sql_; }

  struct Place {
    const Expression* expression = nullptr;
    std::size_t begin = 0;
    std::size_t end = 0;
    bool past_end = false;  ///< SQLite stumbled over our bracket: the text stops too early
  };

  /// The user's token at a byte of the statement.
  [[nodiscard]] std::optional<Place> At(int offset) const {
    if (offset < 0) return std::nullopt;
    const auto at = static_cast<std::size_t>(offset);
    const Piece* nearest = nullptr;
    for (const Piece& piece : pieces_) {
      if (piece.sql_begin <= at) nearest = &piece;
    }
    if (nearest == nullptr) return std::nullopt;
    const std::size_t inside = nearest->begin + std::min(at - nearest->sql_begin, nearest->length);
    if (at >= nearest->sql_begin + nearest->length) {
      return Place{
          .expression = nearest->expression, .begin = inside, .end = inside + 1, .past_end = true};
    }
    for (const Token& token : nearest->expression->tokens) {
      if (inside < token.end) {
        return Place{.expression = nearest->expression, .begin = token.begin, .end = token.end};
      }
    }
    return std::nullopt;
  }

  /// The first token of any text that reads `word`.
  [[nodiscard]] std::optional<Place> Find(std::string_view word) const {
    for (const Piece& piece : pieces_) {
      for (const Token& token : piece.expression->tokens) {
        if (SameWord(Unquoted(piece.expression->TextOf(token)), word)) {
          return Place{.expression = piece.expression, .begin = token.begin, .end = token.end};
        }
      }
    }
    return std::nullopt;
  }

 private:
  void AppendPiece(const Expression& expression, std::size_t begin, const std::string& sql) {
    pieces_.push_back({.sql_begin = sql_.size(),
                       .length = sql.size(),
                       .expression = &expression,
                       .begin = begin});
    sql_ += sql;
  }

  struct Piece {
    std::size_t sql_begin;
    std::size_t length;
    const Expression* expression;
    std::size_t begin;
  };
  std::string sql_;
  std::vector<Piece> pieces_;
};

using Views = std::map<std::string, std::vector<std::string>>;

struct Prepared {
  struct Text {
    Expression expression;
    std::vector<ListItem> items;
    std::vector<MetricTerms::Term> terms;
  };
  Text where;
  Text columns;
  Text sort;
  std::vector<std::string> names;
  Composition composition;
};

std::string QuotedName(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string Unique(const std::string& name, const std::vector<std::string>& taken) {
  std::string unique = name;
  for (int i = 2; std::find(taken.begin(), taken.end(), unique) != taken.end(); ++i) {
    unique = fmt::format("{}_{}", name, i);
  }
  return unique;
}

std::string JoinedNames(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void AppendColumns(Prepared& prepared) {
  const Prepared::Text& columns = prepared.columns;
  for (const ListItem& item : columns.items) {
    const std::size_t begin = columns.expression.tokens[item.first].begin;
    const std::size_t end = columns.expression.tokens[item.last - 1].end;
    const std::string text = columns.expression.text.substr(begin, end - begin);
    const std::string name = !item.alias.empty() ? item.alias : Unquoted(text);
    if (!prepared.names.empty()) prepared.composition.Append(", ");
    prepared.names.push_back(Unique(name, prepared.names));
    prepared.composition.AppendOperand(columns.expression, columns.terms, item.first, item.last);
    prepared.composition.Append(" AS " + QuotedName(prepared.names.back()));
  }
}

/// Judges all texts before any is refused.
Diagnostics ReadTexts(const QueryRequest& request,
                      const std::string& wanted,
                      MetricTerms& metrics,
                      Prepared& prepared) {
  Diagnostics found;
  const auto keep = [&found](const auto& parsed) {
    if (!parsed) found.insert(found.end(), parsed.error().begin(), parsed.error().end());
    return parsed.has_value();
  };
  const auto terms = [&](Prepared::Text& text) {
    if (auto named = metrics.In(text.expression); keep(named)) text.terms = *std::move(named);
  };
  if (auto where = Scan(request.where, "where"); keep(where)) {
    prepared.where.expression = *std::move(where);
    terms(prepared.where);
  }
  if (auto text = Scan(wanted, "columns"); keep(text)) {
    prepared.columns.expression = *std::move(text);
    if (auto items = SplitColumns(prepared.columns.expression); keep(items))
      prepared.columns.items = *std::move(items);
    terms(prepared.columns);
  }
  if (auto text = Scan(request.sort, "sort"); keep(text) && !text->tokens.empty()) {
    prepared.sort.expression = *std::move(text);
    if (auto items = SplitSort(prepared.sort.expression); keep(items))
      prepared.sort.items = *std::move(items);
    terms(prepared.sort);
  }
  return found;
}

/// SELECT (columns) FROM layouts JOIN metrics WHERE (where) ORDER BY (sort) LIMIT n
Parsed<std::unique_ptr<Prepared>> Compose(const QueryRequest& request,
                                          const Views& views,
                                          SQLite::Database& db) {
  std::string wanted = request.columns;
  const auto blank = [](const std::string& text) {
    return text.find_first_not_of(" \t\r\n") == std::string::npos;
  };
  if (blank(wanted)) wanted = kDefaultColumns;
  if (wanted.find_first_not_of(" \t\r\n*") == std::string::npos)
    wanted = JoinedNames(views.at("layouts"));

  MetricTerms metrics(db);
  auto prepared = std::make_unique<Prepared>();
  if (Diagnostics found = ReadTexts(request, wanted, metrics, *prepared); !found.empty())
    return tl::make_unexpected(std::move(found));

  Composition& composition = prepared->composition;
  composition.Append("SELECT ");
  AppendColumns(*prepared);
  composition.Append(" FROM layouts" + metrics.Joins());
  const Prepared::Text& where = prepared->where;
  if (!where.expression.tokens.empty()) {
    composition.Append(" WHERE ");
    composition.AppendOperand(where.expression, where.terms, 0, where.expression.tokens.size());
  }
  const Prepared::Text& sort = prepared->sort;
  for (std::size_t i = 0; i < sort.items.size(); ++i) {
    const ListItem& item = sort.items[i];
    composition.Append(i == 0 ? " ORDER BY " : ", ");
    composition.AppendOperand(sort.expression, sort.terms, item.first, item.last);
    composition.Append(item.direction);
  }
  // One row more than asked tells whether there are more.
  if (request.limit > 0) composition.Append(fmt::format(" LIMIT {}", request.limit + 1));
  return prepared;
}

Diagnostic Placed(const std::optional<Composition::Place>& place,
                  std::string code,
                  std::string message,
                  std::string help) {
  if (!place) return Complaint(std::move(code), "query", std::move(message), std::move(help));
  return place->expression->At(
      place->begin, place->end, std::move(code), std::move(message), std::move(help));
}

Diagnostic FromDenial(const Permissions& permissions, const Composition& composition) {
  const Permissions::Denial& denied = permissions.Denied();
  const std::optional<Composition::Place> place = composition.Find(denied.name);
  switch (denied.kind) {
    case Permissions::Denial::Kind::kTable: {
      std::vector<std::string> views;
      for (const auto& [view, columns] : permissions.Views()) views.push_back(view);
      return Placed(place,
                    "E0523",
                    fmt::format("'{}' cannot be read by a query", denied.name),
                    "readable are " + JoinedNames(views));
    }
    case Permissions::Denial::Kind::kFunction:
      return Placed(place,
                    "E0523",
                    fmt::format("the function '{}' is not allowed in a query", denied.name),
                    DidYouMean(denied.name, Permissions::Functions(), 100));
    case Permissions::Denial::Kind::kRecursion:
      return Placed(place, "E0523", "recursion is not allowed in a query", "");
    default:
      break;
  }
  return Placed(place, "E0523", "a query can only read", "");
}

/// Columns of `layouts` first, they are meant most often.
std::vector<std::string> ColumnNames(const Views& views) {
  std::vector<std::string> names = views.at("layouts");
  for (const auto& [view, columns] : views) {
    for (const std::string& column : columns) {
      if (std::find(names.begin(), names.end(), column) == names.end()) names.push_back(column);
    }
  }
  return names;
}

Diagnostic FromError(const Composition& composition,
                     const Views& views,
                     const std::string& message,
                     int offset) {
  const std::optional<Composition::Place> place = composition.At(offset);
  const auto after = [&message](std::string_view prefix) -> std::optional<std::string> {
    return message.starts_with(prefix) ? std::optional(message.substr(prefix.size()))
                                       : std::nullopt;
  };
  if (const auto column = after("no such column: ")) {
    const bool quoted = place && place->expression->text.substr(place->begin, 1) == "\"";
    const std::string bare = column->substr(column->rfind('.') + 1);
    return Placed(place,
                  "E0521",
                  fmt::format("no column is called '{}'", *column),
                  quoted ? fmt::format("text stands in single quotes: '{}'", *column)
                         : DidYouMean(bare, ColumnNames(views), 30));
  }
  if (const auto table = after("no such table: ")) {
    std::vector<std::string> names;
    for (const auto& [view, columns] : views) names.push_back(view);
    return Placed(place ? place : composition.Find(*table),
                  "E0522",
                  fmt::format("no view is called '{}'", *table),
                  DidYouMean(*table, names));
  }
  if (const auto function = after("no such function: ")) {
    return Placed(place ? place : composition.Find(*function),
                  "E0523",
                  fmt::format("no function is called '{}'", *function),
                  DidYouMean(*function, Permissions::Functions(), 100));
  }
  if (place && place->past_end) return Placed(place, "E0520", "the expression ends too early", "");
  return Placed(place, "E0520", message, "");
}

using StatementPtr = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

/// `sql` is the composition, with or without an EXPLAIN in front.
Parsed<StatementPtr> PrepareOn(SQLite::Database& db,
                               Permissions& permissions,
                               const Composition& composition,
                               const std::string& sql,
                               const std::string& file) {
  permissions.Reset();
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(db.getHandle(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  if (code == SQLITE_OK) return StatementPtr(raw, &sqlite3_finalize);
  if (permissions.Denied().kind != Permissions::Denial::Kind::kNone) {
    return tl::make_unexpected(Diagnostics{FromDenial(permissions, composition)});
  }
  const std::string message = sqlite3_errmsg(db.getHandle());
  switch (code & 0xFF) {
    case SQLITE_ERROR: {
      const int before = static_cast<int>(sql.size() - composition.Sql().size());
      const int offset = sqlite3_error_offset(db.getHandle());
      const int own = offset < 0 ? -1 : offset - before;
      return tl::make_unexpected(
          Diagnostics{FromError(composition, permissions.Views(), message, own)});
    }
    case SQLITE_TOOBIG:
    case SQLITE_NOMEM:
      return Refuse("E0527", "query", "the query is too large");
    default:
      return tl::make_unexpected(Diagnostics{FromSqlite(code, message, file)});
  }
}

Parsed<StatementPtr> Prepare(SQLite::Database& db,
                             Permissions& permissions,
                             const Composition& composition,
                             const std::string& sql,
                             const std::string& file) {
  return PrepareOn(permissions.Shadow(), permissions, composition, sql, file)
      .and_then(
          [&](const StatementPtr&) { return PrepareOn(db, permissions, composition, sql, file); });
}

/// SQLite's texts are bytes; anything that is not UTF-8 (only a cast makes it) is shown as what it
/// is.
std::string TextAt(sqlite3_stmt* statement, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column));
  const std::string_view text =
      bytes == nullptr ? std::string_view() : std::string_view(bytes, size);
  if (sqlite3_column_type(statement, column) == SQLITE_TEXT && IsText(text))
    return std::string(text);
  std::string hex = "x'";
  for (const char byte : text) hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return hex + "'";
}

Value ValueAt(sqlite3_stmt* statement, int column) {
  switch (sqlite3_column_type(statement, column)) {
    case SQLITE_NULL:
      return std::monostate{};
    case SQLITE_INTEGER:
      return static_cast<std::int64_t>(sqlite3_column_int64(statement, column));
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, column);
    default:
      return TextAt(statement, column);
  }
}

std::size_t BytesOf(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return sizeof(Value) + (text == nullptr ? 0 : text->size());
}

std::string TypeOf(const Table& table, std::size_t column) {
  static constexpr std::array<std::string_view, 4> kTypes = {"null", "integer", "real", "text"};
  std::size_t type = 0;
  for (const std::vector<Value>& row : table.rows) {
    const std::size_t own = row[column].index();
    if (own == 0 || own == type) continue;
    if (type == 3 || (own == 3 && type != 0)) return "mixed";
    type = std::max(type, own);  // integers among reals are reals
  }
  return std::string(kTypes.at(type));
}

Diagnostic FromStop(Watch::Stop stop, const QueryLimits& limits) {
  if (stop == Watch::Stop::kTime) {
    return Complaint("E0526",
                     "query",
                     fmt::format("stopped after {} ms", limits.deadline.count()),
                     "make the condition narrower, or allow more time");
  }
  return Complaint("E0527",
                   "query",
                   fmt::format("needs more than {} MB of memory", limits.memory_bytes >> 20U),
                   "make the condition narrower, or sort by a column with an index");
}

}  // namespace

Parsed<Table> Reader::Query(const QueryRequest& request) {
  const auto prepared = Compose(request, permissions_->Views(), db_);
  if (!prepared) return tl::make_unexpected(prepared.error());
  const Composition& composition = (*prepared)->composition;
  const Watch watch(db_, request.limits);
  const auto statement = Prepare(db_, *permissions_, composition, composition.Sql(), file_);
  if (!statement) return tl::make_unexpected(statement.error());

  Table table;
  for (const std::string& name : (*prepared)->names)
    table.columns.push_back({.name = name, .type = ""});
  std::size_t bytes = 0;
  int code = sqlite3_step(statement->get());
  for (; code == SQLITE_ROW; code = sqlite3_step(statement->get())) {
    if (request.limit > 0 && std::ssize(table.rows) == request.limit) {
      table.more = true;
      code = SQLITE_DONE;
      break;
    }
    std::vector<Value>& row = table.rows.emplace_back();
    row.reserve(table.columns.size());
    for (int i = 0; i < static_cast<int>(table.columns.size()); ++i) {
      bytes += BytesOf(row.emplace_back(ValueAt(statement->get(), i)));
    }
    if (bytes > request.limits.result_bytes) {
      return Refuse(
          "E0527",
          "query",
          fmt::format("the answer is larger than {} MB", request.limits.result_bytes >> 20U),
          "give a limit, or fewer columns");
    }
  }
  if (watch.Reason() != Watch::Stop::kNone) {
    return tl::make_unexpected(Diagnostics{FromStop(watch.Reason(), request.limits)});
  }
  const std::string message = sqlite3_errmsg(db_.getHandle());
  switch (code & 0xFF) {
    case SQLITE_DONE:
      break;
    case SQLITE_TOOBIG:
      return Refuse("E0527", "query", "a text of the query grows too long");
    case SQLITE_NOMEM:
      return Refuse("E0527", "query", "the query needs too much memory");
    case SQLITE_ERROR:
      return Refuse(
          "E0528", "query", fmt::format("the expression cannot be computed: {}", message));
    default:
      return tl::make_unexpected(Diagnostics{FromSqlite(code, message, file_)});
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) table.columns[i].type = TypeOf(table, i);
  return table;
}

Parsed<std::vector<std::string>> Reader::Explain(const QueryRequest& request) {
  const auto prepared = Compose(request, permissions_->Views(), db_);
  if (!prepared) return tl::make_unexpected(prepared.error());
  const Composition& composition = (*prepared)->composition;
  const auto statement =
      Prepare(db_, *permissions_, composition, "EXPLAIN QUERY PLAN " + composition.Sql(), file_);
  if (!statement) return tl::make_unexpected(statement.error());
  std::vector<std::string> steps;
  while (sqlite3_step(statement->get()) == SQLITE_ROW) steps.push_back(TextAt(statement->get(), 3));
  return steps;
}

}  // namespace kompono::catalog
