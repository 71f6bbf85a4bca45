// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_STORE_HPP_
#define KOMPONO_CATALOG_STORE_HPP_

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kompono/catalog/query.hpp"
#include "kompono/catalog/record.hpp"
#include "kompono/catalog/search.hpp"
#include "kompono/catalog/study.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

namespace kompono::catalog {

enum class OpenMode {
  kReadOnly,   ///< must exist; nothing can be changed, not even the schema
  kReadWrite,  ///< must exist; an older schema is brought up to date
  kCreate,     ///< as kReadWrite, and made if it does not exist
};

struct OpenOptions {
  OpenMode mode = OpenMode::kReadOnly;
  std::chrono::milliseconds busy_timeout{5000};  ///< how long to wait for another program's write
};

enum class AddStatus {
  kAdded,
  kUpdated,    ///< the layout was there; its text or results were new
  kUnchanged,  ///< all of it was there
};

struct AddResult {
  std::int64_t id = 0;
  AddStatus status = AddStatus::kAdded;
};

struct AddOptions {
  /// 0: all or nothing. Otherwise a transaction is closed after so many layouts, and those before a
  /// failing one stay.
  std::size_t layouts_per_transaction = 0;
};

struct ListOptions {
  std::int64_t limit = 100;  ///< 0: all
  std::int64_t after_id = 0;
};

struct LayoutSummary {
  std::int64_t id = 0;
  std::string name;
  std::string formula;
  std::string hash;
  std::optional<double> rms_after_um;
  std::string added_at;
};

using Count = std::pair<std::string, std::int64_t>;

struct Statistics {
  int schema_version = 0;
  std::int64_t file_bytes = 0;
  std::int64_t layouts = 0;
  std::int64_t open_base_layouts = 0;
  std::int64_t calibrated_layouts = 0;
  std::int64_t formulas = 0;
  std::int64_t distributions = 0;
  std::int64_t relative_motions = 0;
  std::int64_t parameters = 0;
  std::int64_t metrics = 0;
  std::int64_t failed_metrics = 0;
  std::int64_t calibrations = 0;
  std::int64_t evaluations = 0;
  std::int64_t evaluations_ok = 0;
  std::int64_t evaluations_rejected = 0;
  std::int64_t evaluations_failed = 0;
  std::vector<Count> studies;   ///< evaluations per study
  std::vector<Count> rejected;  ///< evaluations per "stage: reason" that are not ok, most first
  std::vector<Count> modules;   ///< layouts per module, most used first
  std::vector<Count> plugins;   ///< layouts per plugin "id version", most used first
  std::vector<Count> programs;  ///< layouts per program version
};

[[nodiscard]] nlohmann::ordered_json ToJson(const Statistics& statistics);

/// What `Store::Verify` looked at and what it found (E0530-E0534, E0545-E0547).
struct VerifyReport {
  std::int64_t layouts = 0;
  std::int64_t calibrations = 0;
  std::int64_t evaluations = 0;
  Diagnostics findings;
  [[nodiscard]] bool Ok() const { return findings.empty(); }
};

struct MergeResult {
  std::int64_t layouts_added = 0;
  std::int64_t layouts_updated = 0;
  std::int64_t layouts_unchanged = 0;
  std::int64_t studies_added = 0;
  std::int64_t evaluations_written = 0;
  std::int64_t evaluations_skipped = 0;
};

enum class ExportFormat {
  kJson,  ///< one file, one layout or evaluation per line
  kCsv,   ///< a folder with one table per file
  kToml,  ///< a folder with one layout file per layout
};

struct ExportSummary {
  std::int64_t layouts = 0;
  std::int64_t evaluations = 0;
  std::int64_t files = 0;
};

/// The catalog of machine layouts, one SQLite file.
///
///     Parsed<Store> store = Store::Open("machines.db", {.mode = OpenMode::kCreate});
///     if (!store) return Complain(store.error());
///     Parsed<AddResult> added = store->Add(record);
///     Parsed<Table> good = store->Query({.where = "rms_after_um < 100", .sort = "rms_after_um"});
///
/// Every function returns its value or all complaints (E05xx, docs/catalog.md); none throws for
/// what the file or the user did. One Store serves one thread at a time; several Stores and
/// programs may have the same file open, one writing and any number reading. The file must lie on a
/// local disk: SQLite's locks are not safe on network shares.
class Store {
 public:
  [[nodiscard]] static Parsed<Store> Open(const std::filesystem::path& path,
                                          const OpenOptions& options = {});

  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;
  ~Store();

  /// Notes from opening, such as the copy made before a migration (N0501).
  [[nodiscard]] const Diagnostics& Notes() const;

  /// Adds a layout, or what is new about one that is already there. Metrics and capabilities given
  /// replace those of the same name and method, calibrations are kept side by side, what is not
  /// given stays.
  [[nodiscard]] Parsed<AddResult> Add(const LayoutRecord& record);

  /// The same for many; results in the order of `records`. All records are checked before the first
  /// is written.
  [[nodiscard]] Parsed<std::vector<AddResult>> AddAll(std::span<const LayoutRecord> records,
                                                      const AddOptions& options = {});

  /// For some ten thousand new layouts and more: between the two calls five indexes are left out,
  /// which are quicker made at once than row by row. Whatever was added in between stays if
  /// `EndBulk` is never reached; the next program that opens the file for writing makes the
  /// indexes. Until then queries are slow. `EndBulk` keeps other writers waiting for seconds per
  /// million layouts.
  [[nodiscard]] Diagnostics BeginBulk();
  [[nodiscard]] Diagnostics EndBulk();

  /// The id of a study, which is added if it is not there: the start of a run and its resumption.
  [[nodiscard]] Parsed<std::int64_t> BeginStudy(const StudyRecord& study);

  /// Writes the evaluations of `range` and marks it done, in one transaction. Candidates that are
  /// done stay as they are.
  [[nodiscard]] Parsed<AppendResult> AppendChunk(std::int64_t study,
                                                 const IndexRange& range,
                                                 std::span<const EvaluationRecord> records);

  /// The parts of `whole` that are not done, ascending.
  [[nodiscard]] Parsed<std::vector<IndexRange>> MissingRanges(std::int64_t study,
                                                              const IndexRange& whole) const;

  /// In the order of candidates; what is not done is left out. Layouts come with name, formula,
  /// blocks and parameters if `with_layouts`.
  [[nodiscard]] Parsed<std::vector<EvaluationRecord>> Evaluations(std::int64_t study,
                                                                  const IndexRange& range,
                                                                  bool with_layouts = false) const;

  /// In the order of ids.
  [[nodiscard]] Parsed<std::vector<StudySummary>> Studies() const;

  /// Takes over all layouts, studies and evaluations of `other`. Doing it again changes nothing.
  [[nodiscard]] Parsed<MergeResult> Merge(const Store& other);

  /// `key` is a name, an id, or at least four digits of a hash, tried in this order.
  [[nodiscard]] Parsed<StoredLayout> Show(std::string_view key) const;

  /// The layout file's text as it was added.
  [[nodiscard]] Parsed<std::string> Export(std::string_view key) const;

  /// In the order of ids.
  [[nodiscard]] Parsed<std::vector<LayoutSummary>> List(const ListOptions& options = {}) const;

  [[nodiscard]] Parsed<Statistics> Stats() const;

  /// SQLite's own check, foreign keys, the schema against this program's, every hash recomputed.
  [[nodiscard]] Parsed<VerifyReport> Verify() const;

  /// Answers over a connection that can only read the documented views, within `request.limits`.
  [[nodiscard]] Parsed<Table> Query(const QueryRequest& request) const;

  /// Layouts and studies with all the words of `text`, best first. A word that ends in * stands for
  /// all that begin so; nothing else has a meaning of its own.
  [[nodiscard]] Parsed<std::vector<SearchHit>> Search(std::string_view text,
                                                      std::int64_t limit = 20) const;

  /// Layouts whose structure resembles that of the layout `key`, best first, itself left out.
  [[nodiscard]] Parsed<std::vector<SimilarLayout>> Similar(
      std::string_view key,
      std::int64_t limit = 20,
      std::chrono::milliseconds deadline = std::chrono::seconds(5)) const;

  /// Everything, in an order that depends on the contents only: catalogs with the same layouts and
  /// evaluations give the same bytes, however they came together. Times and ids are left out.
  [[nodiscard]] Parsed<ExportSummary> ExportAll(ExportFormat format,
                                                const std::filesystem::path& out) const;

  /// SQLite's plan for the same request, one step per line: "SEARCH l USING INDEX layout_by_name
  /// (name=?)".
  [[nodiscard]] Parsed<std::vector<std::string>> Explain(const QueryRequest& request) const;

 private:
  class Impl;
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_STORE_HPP_
