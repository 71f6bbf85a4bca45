// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_STORE_IMPL_HPP_
#define KOMPONO_CATALOG_SRC_STORE_IMPL_HPP_

#include "bulk.hpp"
#include "failure.hpp"
#include "guard.hpp"
#include "opening.hpp"
#include "study_writing.hpp"
#include "writing.hpp"
#include <SQLiteCpp/Transaction.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kompono/catalog/store.hpp"

namespace kompono::catalog {

class Store::Impl {
 public:
  Impl(std::filesystem::path file, Opened opened, OpenOptions how)
      : path(std::move(file)),
        options(how),
        immutable(opened.immutable),
        notes(std::move(opened.notes)),
        db(std::move(opened.db)) {}

  Parsed<std::vector<AddResult>> AddAll(std::span<const LayoutRecord> records, std::size_t chunk);
  Parsed<AppendResult> Append(std::int64_t study,
                              const IndexRange& range,
                              std::span<const EvaluationRecord> records,
                              const RunOrigin* origin);
  Parsed<MergeResult> Merge(SQLite::Database& other);
  Parsed<bool> MergeLayouts(SQLite::Database& other, MergeResult& result);
  Parsed<bool> MergeStudy(SQLite::Database& other, std::int64_t study, MergeResult& result);
  Parsed<Reader*> OpenReader();

  /// Runs `work`, which returns a Parsed, in a transaction that is kept if it returns a value.
  template <class Work>
  auto Writing(Work&& work) -> decltype(work());

  [[nodiscard]] std::string Name() const { return path.string(); }

  std::filesystem::path path;
  OpenOptions options;
  bool immutable;
  Diagnostics notes;
  std::unique_ptr<SQLite::Database> db;
  std::unique_ptr<Writer> writer;        // made by the first write, dropped by a rollback
  std::unique_ptr<StudyWriter> studies;  // likewise
  std::unique_ptr<Reader> reader;  // made by the first Query; closed before db, which tidies up
};

template <class Work>
auto Store::Impl::Writing(Work&& work) -> decltype(work()) {
  if (options.mode == OpenMode::kReadOnly) {
    return Refuse("E0502", Name(), "the catalog was opened for reading only");
  }
  auto outcome = Guarded(Name(), [&]() -> decltype(work()) {
    if (!writer) {
      writer = std::make_unique<Writer>(*db);
      studies = std::make_unique<StudyWriter>(*db, *writer);
    }
    SQLite::Transaction transaction(*db, SQLite::TransactionBehavior::IMMEDIATE);
    writer->Begin(BulkLoading(*db));
    auto result = work();
    if (!result) return result;
    studies->Flush();
    transaction.commit();
    return result;
  });
  if (!outcome) {
    studies.reset();
    writer.reset();
  }
  return outcome;
}

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_STORE_IMPL_HPP_
