// SPDX-License-Identifier: Apache-2.0
#include "kompono/catalog/store.hpp"

#include "failure.hpp"
#include "guard.hpp"
#include "opening.hpp"
#include "reading.hpp"
#include "schema.hpp"
#include "verifying.hpp"
#include "writing.hpp"
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

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
  Parsed<Reader*> OpenReader();
  [[nodiscard]] std::string Name() const { return path.string(); }

  std::filesystem::path path;
  OpenOptions options;
  bool immutable;
  Diagnostics notes;
  std::unique_ptr<SQLite::Database> db;
  std::unique_ptr<Writer> writer;  // made by the first Add, dropped by a rollback
  std::unique_ptr<Reader> reader;  // made by the first Query; closed before db, which tidies up
};

Parsed<std::vector<AddResult>> Store::Impl::AddAll(std::span<const LayoutRecord> records,
                                                   std::size_t chunk) {
  if (options.mode == OpenMode::kReadOnly) {
    return Refuse("E0502", Name(), "the catalog was opened for reading only");
  }
  Diagnostics unfit;
  for (const LayoutRecord& record : records) {
    Diagnostics found = Check(record);
    std::move(found.begin(), found.end(), std::back_inserter(unfit));
  }
  if (!unfit.empty()) return tl::make_unexpected(std::move(unfit));

  std::vector<AddResult> results;
  results.reserve(records.size());
  std::size_t kept = 0;
  auto outcome = Guarded(Name(), [&]() -> Parsed<std::size_t> {
    if (!writer) writer = std::make_unique<Writer>(*db);
    const std::size_t step = chunk == 0 ? std::max<std::size_t>(1, records.size()) : chunk;
    for (std::size_t begin = 0; begin < records.size(); begin += step) {
      SQLite::Transaction transaction(*db, SQLite::TransactionBehavior::IMMEDIATE);
      writer->Begin();
      for (const LayoutRecord& record :
           records.subspan(begin, std::min(step, records.size() - begin))) {
        results.push_back(writer->Add(record));
      }
      transaction.commit();
      kept = results.size();
    }
    return kept;
  });
  if (!outcome) {
    writer.reset();
    for (Diagnostic& diagnostic : outcome.error()) {
      diagnostic.message += fmt::format("; {} of {} layouts are stored", kept, records.size());
    }
    return tl::make_unexpected(std::move(outcome.error()));
  }
  return results;
}

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

Parsed<StoredLayout> Store::Show(std::string_view key) const {
  return Guarded(impl_->Name(), [&]() -> Parsed<StoredLayout> {
    // One transaction, so that all tables are read as of one moment.
    SQLite::Transaction snapshot(*impl_->db);
    return FindLayout(*impl_->db, key, impl_->Name()).map([&](std::int64_t id) {
      return ReadLayout(*impl_->db, id);
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

Parsed<Table> Store::Query(const QueryRequest& request) const {
  return impl_->OpenReader().and_then([&](Reader* reader) { return reader->Query(request); });
}

Parsed<std::vector<std::string>> Store::Explain(const QueryRequest& request) const {
  return impl_->OpenReader().and_then([&](Reader* reader) { return reader->Explain(request); });
}

}  // namespace kompono::catalog
