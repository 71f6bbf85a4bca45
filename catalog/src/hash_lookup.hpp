// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_
#define KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_

#include "command.hpp"
#include <SQLiteCpp/Database.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kompono/catalog/hash.hpp"

namespace kompono::catalog {

/// Ids of layouts under the first eight bytes of their hashes, in one flat table: with a million of
/// them a step through a list of nodes costs as much as writing a row.
class KnownHashes {
 public:
  void Clear();
  void Add(std::int64_t key, std::int64_t id);
  /// The first id for which `is` says yes, of those under the key.
  template <class Is>
  [[nodiscard]] std::optional<std::int64_t> Find(std::int64_t key, const Is& is) const {
    if (slots_.empty()) return std::nullopt;
    for (std::size_t i = PlaceOf(key); slots_[i].id != 0; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i].key == key && is(slots_[i].id)) return slots_[i].id;
    }
    return std::nullopt;
  }

 private:
  struct Slot {
    std::int64_t key = 0;
    std::int64_t id = 0;  // 0: free; SQLite counts from 1
  };
  /// Keys are spread evenly: any of their bits will do.
  [[nodiscard]] std::size_t PlaceOf(std::int64_t key) const {
    return static_cast<std::uint64_t>(key) & (slots_.size() - 1);
  }
  void Put(const Slot& slot);

  std::vector<Slot> slots_;  // a power of two of them, at most two thirds in use
  std::size_t used_ = 0;
};

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
  std::int64_t newest_ = 0;  // the largest id that known_ has
  KnownHashes known_;
  Command by_index_;
  Command by_id_;
};

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_HASH_LOOKUP_HPP_
