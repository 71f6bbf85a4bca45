// SPDX-License-Identifier: Apache-2.0
// chunk_writer DB CANDIDATES CHUNK [bulk]: evaluates a study into a catalog, as a synthesis run
// does, until nothing is missing. Prints "begin end" of each chunk after it was committed. For
// tests that kill it.
#include "study_fixture.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

using kompono::Diagnostics;
using kompono::catalog::IndexRange;
using kompono::catalog::OpenMode;
using kompono::catalog::Store;

int Complain(const Diagnostics& complaints) {
  fmt::print(stderr, "{}", RenderAll(complaints, {}));
  return 1;
}

int Run(const char* file, std::int64_t candidates, std::int64_t chunk, bool bulk) {
  auto store = Store::Open(file, {.mode = OpenMode::kCreate});
  if (!store) return Complain(store.error());
  if (bulk) {
    if (const Diagnostics trouble = store->BeginBulk(); !trouble.empty()) return Complain(trouble);
  }
  const auto study = store->BeginStudy(kompono::catalog::SheetStudy(candidates));
  if (!study) return Complain(study.error());
  const auto missing = store->MissingRanges(*study, {0, candidates});
  if (!missing) return Complain(missing.error());
  for (const IndexRange& hole : *missing) {
    for (std::int64_t i = hole.begin; i < hole.end; i += chunk) {
      const IndexRange range{i, std::min(i + chunk, hole.end)};
      const auto appended = store->AppendChunk(*study, range, EvaluatedAll(range));
      if (!appended) return Complain(appended.error());
      fmt::print("{} {}\n", range.begin, range.end);
      std::fflush(stdout);
    }
  }
  if (bulk) {
    if (const Diagnostics trouble = store->EndBulk(); !trouble.empty()) return Complain(trouble);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const bool bulk = argc > 4 && std::string_view(argv[4]) == "bulk";
  return Run(argv[1], std::atoll(argv[2]), std::atoll(argv[3]), bulk);
}
