// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/store.hpp"

#include "exporting.hpp"
#include "reading.hpp"
#include "schema.hpp"
#include "searching.hpp"
#include "store_impl.hpp"
#include "study_reading.hpp"
#include "verifying.hpp"
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <optional>

namespace kompono::catalog {

Parsed<Reader*> Store::Impl::OpenReader() {
  if (!reader) {
    auto made = Guarded(Name(), [&]() -> Parsed<std::unique_ptr<Reader>> {
      return std::make_unique<Reader>(UriOf(path, immutable), Name(), options.busy_timeout);
    });
    if (!made) return tl::make_unexpected(std::move(made.error()));
    reader = *std::move(made);
  }
  return reader.get();
}

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Parsed<Store> Store::Open(const std::filesystem::path& path, const OpenOptions& options) {
  Parsed<Opened> opened = OpenCatalog(path, options);
  if (!opened) return tl::make_unexpected(std::move(opened.error()));
  return Store(std::make_unique<Impl>(path, *std::move(opened), options));
}

const Diagnostics& Store::Notes() const {
  return impl_->notes;
}

Parsed<AddResult> Store::Add(const LayoutRecord& record) {
  return impl_->AddAll({&record, 1}, 0).map([](const std::vector<AddResult>& results) {
    return results.front();
  });
}

Parsed<std::vector<AddResult>> Store::AddAll(std::span<const LayoutRecord> records,
                                             const AddOptions& options) {
  return impl_->AddAll(records, options.layouts_per_transaction);
}

Diagnostics Store::BeginBulk() {
  auto outcome = Guarded(impl_->Name(), [&]() -> Parsed<bool> {
    catalog::BeginBulk(*impl_->db);
    return true;
  });
  return outcome ? Diagnostics{} : std::move(outcome.error());
}

Diagnostics Store::EndBulk() {
  auto outcome = Guarded(impl_->Name(), [&]() -> Parsed<bool> {
    catalog::EndBulk(*impl_->db);
    return true;
  });
  return outcome ? Diagnostics{} : std::move(outcome.error());
}

Parsed<std::int64_t> Store::BeginStudy(const StudyRecord& study) {
  if (Diagnostics unfit = Check(study); !unfit.empty())
    return tl::make_unexpected(std::move(unfit));
  return impl_->Writing([&]() -> Parsed<std::int64_t> { return impl_->studies->Begin(study).id; });
}

Parsed<AppendResult> Store::AppendChunk(std::int64_t study,
                                        const IndexRange& range,
                                        std::span<const EvaluationRecord> records) {
  return impl_->Append(study, range, records, nullptr);
}

Parsed<std::vector<IndexRange>> Store::MissingRanges(std::int64_t study,
                                                     const IndexRange& whole) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<IndexRange>> {
    const SQLite::Transaction snapshot(*impl_->db);
    if (!CandidatesOf(*impl_->db, study))
      return Refuse("E0541", impl_->Name(), fmt::format("there is no study {}", study));
    return catalog::MissingRanges(*impl_->db, study, whole);
  });
}

Parsed<std::vector<EvaluationRecord>> Store::Evaluations(std::int64_t study,
                                                         const IndexRange& range,
                                                         bool with_layouts) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<EvaluationRecord>> {
    const SQLite::Transaction snapshot(*impl_->db);
    if (!CandidatesOf(*impl_->db, study))
      return Refuse("E0541", impl_->Name(), fmt::format("there is no study {}", study));
    using Layouts = EvaluationReader::Layouts;
    EvaluationReader reader(*impl_->db, with_layouts ? Layouts::kStructure : Layouts::kNone);
    reader.Start(study, range);
    std::vector<EvaluationRecord> evaluations;
    for (EvaluationRecord record; reader.Next(record);) evaluations.push_back(record);
    return evaluations;
  });
}

Parsed<std::vector<StudySummary>> Store::Studies() const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<StudySummary>> {
    const SQLite::Transaction snapshot(*impl_->db);
    return ReadStudies(*impl_->db);
  });
}

Parsed<MergeResult> Store::Merge(const Store& other) {
  std::error_code ignored;
  if (std::filesystem::equivalent(impl_->path, other.impl_->path, ignored))
    return Refuse("E0549", impl_->Name(), "a catalog cannot be merged into itself");
  return Guarded(other.impl_->Name(), [&]() -> Parsed<MergeResult> {
    const SQLite::Transaction snapshot(*other.impl_->db);
    return impl_->Merge(*other.impl_->db);
  });
}

Parsed<StoredLayout> Store::Show(std::string_view key) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<StoredLayout> {
    // One transaction, so that all tables are read as of one moment.
    const SQLite::Transaction snapshot(*impl_->db);
    return FindLayout(*impl_->db, key, impl_->Name()).map([&](std::int64_t id) {
      return LayoutReader(*impl_->db).Read(id);
    });
  });
}

Parsed<std::string> Store::Export(std::string_view key) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::string> {
    SQLite::Transaction snapshot(*impl_->db);
    return FindLayout(*impl_->db, key, impl_->Name()).map([&](std::int64_t id) {
      return ReadToml(*impl_->db, id);
    });
  });
}

Parsed<std::vector<LayoutSummary>> Store::List(const ListOptions& options) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<LayoutSummary>> {
    return ReadList(*impl_->db, options);
  });
}

Parsed<Statistics> Store::Stats() const {
  return Guarded(impl_->Name(), [&]() -> Parsed<Statistics> {
    SQLite::Transaction snapshot(*impl_->db);
    return ReadStatistics(*impl_->db);
  });
}

Parsed<VerifyReport> Store::Verify() const {
  return Guarded(impl_->Name(), [&]() -> Parsed<VerifyReport> {
    return VerifyCatalog(*impl_->db, impl_->Name());
  });
}

Parsed<std::vector<SearchHit>> Store::Search(std::string_view text, std::int64_t limit) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<SearchHit>> {
    const SQLite::Transaction snapshot(*impl_->db);
    return SearchWords(*impl_->db, text, limit);
  });
}

Parsed<std::vector<SimilarLayout>> Store::Similar(std::string_view key,
                                                  std::int64_t limit,
                                                  std::chrono::milliseconds deadline) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<std::vector<SimilarLayout>> {
    const SQLite::Transaction snapshot(*impl_->db);
    return FindLayout(*impl_->db, key, impl_->Name()).and_then([&](std::int64_t id) {
      return SearchSimilar(*impl_->db, id, limit, deadline);
    });
  });
}

Parsed<ExportSummary> Store::ExportAll(ExportFormat format,
                                       const std::filesystem::path& out) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<ExportSummary> {
    const SQLite::Transaction snapshot(*impl_->db);
    return ExportCatalog(*impl_->db, format, out);
  });
}

Parsed<Table> Store::Query(const QueryRequest& request) const {
  return impl_->OpenReader().and_then([&](Reader* reader) { return reader->Query(request); });
}

Parsed<std::vector<std::string>> Store::Explain(const QueryRequest& request) const {
  return impl_->OpenReader().and_then([&](Reader* reader) { return reader->Explain(request); });
}

}  // namespace kompono::catalog
