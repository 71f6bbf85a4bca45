// SPDX-License-Identifier: Apache-2.0
#include "hash_lookup.hpp"

#include "record_parts.hpp"
#include <SQLiteCpp/Statement.h>

namespace kompono::catalog {

HashLookup::HashLookup(SQLite::Database& db)
    : db_(db),
      by_index_(db, "SELECT id FROM layout WHERE hash_key = ?1 AND content_hash = ?2"),
      by_id_(db, "SELECT id FROM layout WHERE id = ?1 AND content_hash = ?2") {}

void HashLookup::Begin(bool bulk) {
  bulk_ = bulk;
  if (!bulk_) {
    known_.clear();
    newest_ = 0;
    return;
  }
  SQLite::Statement row(db_, "SELECT id, hash_key FROM layout WHERE id > ? ORDER BY id");
  row.bind(1, newest_);
  while (row.executeStep()) {
    newest_ = row.getColumn(0).getInt64();
    known_.emplace(row.getColumn(1).getInt64(), newest_);
  }
}

std::optional<std::int64_t> HashLookup::Find(const Sha256& digest) {
  const std::int64_t key = KeyOf(digest);
  if (!bulk_) return by_index_.Integer(key).Digest(digest).Look();
  const auto [begin, end] = known_.equal_range(key);
  for (auto i = begin; i != end; ++i) {
    if (auto id = by_id_.Integer(i->second).Digest(digest).Look()) return id;
  }
  return std::nullopt;
}

void HashLookup::Added(const Sha256& digest, std::int64_t id) {
  if (!bulk_) return;
  known_.emplace(KeyOf(digest), id);
  newest_ = id;
}

}  // namespace kompono::catalog
