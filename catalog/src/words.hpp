// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_SRC_WORDS_HPP_
#define KOMPONO_CATALOG_SRC_WORDS_HPP_

namespace kompono::catalog {

/// What full-text search knows of a layout or study, row by row: rowid, name, formula, parts, text.
/// The same texts as in schema/0003_studies.sql; a condition may follow.
inline constexpr const char* kWordsOfLayouts =
    "SELECT 2 * l.id, l.name, f.text, "
    "coalesce((SELECT group_concat(b.name || ' ' || m.name || ' ' || m.plugin, '; ') "
    "FROM layout_block AS b JOIN module AS m ON m.id = b.module_id WHERE b.layout_id = l.id), '') "
    "|| ' ' || coalesce((SELECT group_concat(t.text || ' ' || c.detail, '; ') FROM capability AS c "
    "JOIN term AS t ON t.id = c.name_id WHERE c.layout_id = l.id), ''), t.toml "
    "FROM layout AS l JOIN formula AS f ON f.id = l.formula_id "
    "JOIN layout_text AS t ON t.layout_id = l.id";
inline constexpr const char* kWordsOfStudies =
    "SELECT 2 * s.id + 1, s.name, '', "
    "coalesce((SELECT group_concat(r.first || ' ' || r.second || ' ' || r.reason || ' ' || "
    "r.author, '; ') FROM study_rule AS r WHERE r.study_id = s.id), ''), s.toml FROM study AS s";

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_SRC_WORDS_HPP_
