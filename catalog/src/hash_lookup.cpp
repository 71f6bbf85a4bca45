// SPDX-License-Identifier: Apache-2.0
#include "hash_lookup.hpp"

#include "record_parts.hpp"
#include <SQLiteCpp/Statement.h>

#include <algorithm>
#include <utility>

namespace kompono::catalog {

void KnownHashes::Clear() {
  slots_.clear();
  used_ = 0;
}

void KnownHashes::Add(std::int64_t key, std::int64_t id) {
  if (3 * (used_ + 1) > 2 * slots_.size()) {
    constexpr std::size_t kFewest = 1024;
    const std::vector<Slot> before =
        std::exchange(slots_, std::vector<Slot>(std::max(kFewest, 2 * slots_.size())));
    for (const Slot& slot : before) {
      if (slot.id != 0) Put(slot);
    }
  }
  Put({.key = key, .id = id});
  ++used_;
}

void KnownHashes::Put(const Slot& slot) {
  std::size_t i = PlaceOf(slot.key);
  while (slots_[i].id != 0) i = (i + 1) & (slots_.size() - 1);
  slots_[i] = slot;
}

HashLookup::HashLookup(SQLite::Database& db)
    : db_(db),
      by_index_(db, "SELECT id FROM layout WHERE hash_key = ?1 AND content_hash = ?2"),
      by_id_(db, "SELECT id FROM layout WHERE id = ?1 AND content_hash = ?2") {}

void HashLookup::Begin(bool bulk) {
  bulk_ = bulk;
  if (!bulk_) {
    known_.Clear();
    newest_ = 0;
    return;
  }
  SQLite::Statement row(db_, "SELECT id, hash_key FROM layout WHERE id > ? ORDER BY id");
  row.bind(1, newest_);
  while (row.executeStep()) {
    newest_ = row.getColumn(0).getInt64();
    known_.Add(row.getColumn(1).getInt64(), newest_);
  }
}

std::optional<std::int64_t> HashLookup::Find(const Sha256& digest) {
  const std::int64_t key = KeyOf(digest);
  if (!bulk_) return by_index_.Integer(key).Digest(digest).Look();
  return known_.Find(
      key, [&](std::int64_t id) { return by_id_.Integer(id).Digest(digest).Look().has_value(); });
}

void HashLookup::Added(const Sha256& digest, std::int64_t id) {
  if (!bulk_) return;
  known_.Add(KeyOf(digest), id);
  newest_ = id;
}

}  // namespace kompono::catalog
