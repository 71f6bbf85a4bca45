// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_WRITING_HPP_
#define KOMPONO_CATALOG_SRC_WRITING_HPP_

#include "command.hpp"
#include "hash_lookup.hpp"
#include "waiting_rows.hpp"
#include <SQLiteCpp/Database.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

/// Ids of texts that recur, one statement only for those not met before. Several columns are joined
/// in the key.
class Dictionary {
 public:
  Dictionary(SQLite::Database& db, const std::string& insert, const std::string& select)
      : insert_(db, insert), select_(db, select) {}

  struct Entry {
    std::int64_t id = 0;
    bool written = false;  ///< made or changed by this call
  };
  /// `columns` are bound in their order to both statements; the select need not use the last ones.
  Entry Find(std::span<const std::string_view> columns);

 private:
  Command insert_;
  Command select_;
  std::unordered_map<std::string, std::int64_t> known_;
  std::string key_;
};

/// Prepared statements that put records into the tables; the caller holds the transaction and has
/// checked the records. Rows of new layouts wait and are written some at a time: records must live
/// until `Flush`. After a rollback a Writer is worthless: the ids it remembers may be gone.
class Writer {
 public:
  explicit Writer(SQLite::Database& db);

  /// To be called after the transaction was begun; `bulk`: the index of the hashes may be missing.
  void Begin(bool bulk);
  /// With the words of the layout for full-text search.
  AddResult Add(const LayoutRecord& record);
  /// The layout and its results without words; `metrics` instead of its own.
  struct OfStudy {
    std::int64_t layout = 0;
    std::int64_t formula = 0;
  };
  OfStudy AddOfStudy(const LayoutRecord& record,
                     std::span<const Metric> metrics,
                     std::int64_t provenance);
  /// Writes what waits. Before anything reads or changes new layouts, and before the commit.
  void Flush();

  /// For `Add` the source's hash is that of the layout file if the record gives none.
  std::int64_t ProvenanceOf(const Provenance& provenance, std::string_view text);
  /// Of a formula known by its text only: the rest follows from it.
  std::int64_t FormulaOf(const std::string& text);
  std::int64_t FormulaOf(const LayoutRecord& record);
  std::int64_t MeasureOf(const Metric& metric);
  [[nodiscard]] const std::string& Moment() const { return now_; }

 private:
  /// More layouts do not make the statements quicker, and their rows should stay in the cache.
  static constexpr std::size_t kMostWaiting = 64;

  AddResult Put(const LayoutRecord& record,
                std::int64_t formula,
                std::span<const Metric> metrics,
                std::int64_t provenance);
  [[nodiscard]] std::optional<std::int64_t> Find(const Sha256& digest);
  std::int64_t PutNew(const Sha256& digest,
                      const LayoutRecord& record,
                      std::int64_t formula,
                      std::int64_t provenance);
  std::int64_t TermOf(std::string_view text);
  std::int64_t QuantityOf(std::string_view name, std::string_view unit);
  void FillFormula(std::int64_t id, const std::string& text, std::span<const Motion> motions);
  void AddStructure(std::int64_t layout, const LayoutRecord& record);
  int RefreshDerived(std::int64_t layout, const LayoutRecord& record);
  int RefreshText(std::int64_t layout, const LayoutRecord& record, std::int64_t provenance);
  int AddMetrics(std::int64_t layout, std::span<const Metric> metrics, std::int64_t provenance);
  int AddCapabilities(std::int64_t layout, const LayoutRecord& record, std::int64_t provenance);
  int AddCalibrations(std::int64_t layout, const LayoutRecord& record, std::int64_t provenance);

  SQLite::Database& db_;
  std::string now_;                // one moment for all rows of a transaction
  std::optional<Provenance> run_;  // of the record before: most often the same again
  std::int64_t run_id_ = 0;
  HashLookup hashes_;
  std::int64_t newest_layout_ = 0;
  std::array<Sha256, kMostWaiting> waiting_digests_{};
  std::size_t waiting_ = 0;                      // new layouts whose rows are not written
  std::vector<std::int64_t> waiting_for_words_;  // of them, for full-text search
  Dictionary formulas_;
  std::unordered_map<std::string, std::int64_t> known_texts_;
  Command formula_texts_;
  Dictionary provenances_;
  Dictionary modules_;
  Dictionary quantities_;
  Dictionary measures_;
  Dictionary terms_;
  Command tree_;
  Command clear_motions_;
  Command motion_;
  Command plugin_;
  WaitingRows layout_;
  WaitingRows text_;
  Command refresh_derived_;
  Command refresh_text_;
  Command refresh_provenance_;
  WaitingRows block_;
  WaitingRows parameter_;
  WaitingRows fresh_metric_;
  WaitingRows fresh_capability_;
  Command metric_;
  Command capability_;
  Command calibration_;
  Command has_words_;
  Command clear_words_;
  Command words_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_WRITING_HPP_
