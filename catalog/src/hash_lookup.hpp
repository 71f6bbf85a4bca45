// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_
#define KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_

#include "command.hpp"
#include <SQLiteCpp/Database.h>

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "kompono/catalog/hash.hpp"

namespace kompono::catalog {

/// The id of the layout with a hash. While loading in bulk the file has no index of hashes: it is
/// kept in memory, eight bytes of each, and reads at the start of a transaction what others added.
class HashLookup {
 public:
  explicit HashLookup(SQLite::Database& db);

  /// After the transaction was begun.
  void Begin(bool bulk);
  [[nodiscard]] std::optional<std::int64_t> Find(const Sha256& digest);
  void Added(const Sha256& digest, std::int64_t id);

 private:
  SQLite::Database& db_;
  bool bulk_ = false;
  std::int64_t newest_ = 0;                                    // the largest id that known_ has
  std::unordered_multimap<std::int64_t, std::int64_t> known_;  // eight bytes of the hash to ids
  Command by_index_;
  Command by_id_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_
