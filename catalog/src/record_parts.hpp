// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_RECORD_PARTS_HPP_
#define KOMPONO_CATALOG_SRC_RECORD_PARTS_HPP_

#include <cstdint>
#include <string>
#include <string_view>

#include "kompono/catalog/hash.hpp"
#include "kompono/catalog/record.hpp"
#include "kompono/catalog/study.hpp"

namespace kompono::catalog {

[[nodiscard]] Sha256 ContentDigest(const LayoutRecord& record);
[[nodiscard]] Sha256 ContentDigest(const Calibration& calibration);
[[nodiscard]] Sha256 ContentDigest(const StudyRecord& study);

/// The first eight bytes, big-endian: what `layout.hash_key` holds.
[[nodiscard]] std::int64_t KeyOf(const Sha256& digest);

/// "lambda 1.0.0, spindle 1.2.0", sorted: equal sets print equal text.
[[nodiscard]] std::string PluginText(const Provenance& provenance);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_RECORD_PARTS_HPP_
