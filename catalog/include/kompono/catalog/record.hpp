// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_RECORD_HPP_
#define KOMPONO_CATALOG_RECORD_HPP_

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// What goes into the catalog and comes out of it, as plain values:
///
///     const LayoutRecord record{.name = "Lambda water-jet",
///                               .formula = "part_xy (XY):drive O|O Z P_z",
///                               .open_base = true,
///                               .coordinates = 3,
///                               .drives = 3,
///                               .blocks = {{.name = "drive", .module = "lambda", .plugin =
///                               "lambda"}}, .parameters = {{.name = "drive.L1", .value = 1200.0,
///                               .unit = "mm"}}, .toml = text};
namespace kompono::catalog {

struct PluginVersion {
  std::string id;
  std::string version;
};

/// Who made a row and from which file.
struct Provenance {
  std::string program_version;         ///< empty: the version of this program
  std::vector<PluginVersion> plugins;  ///< those whose code took part, any order
  std::string source_path;             ///< as the user named it; empty if there was no file
  std::string source_sha256;           ///< 64 hex digits; empty: of the record's `toml`
};

enum class Side { kWorkpiece, kTool };

/// One axis of the formula, in the formula's order.
struct Motion {
  std::string axis;  ///< "X", "C2", "C_v"
  Side side = Side::kWorkpiece;
  bool working = true;  ///< false: a setting motion, lower case in the formula
  std::string block;    ///< the block that realises it; empty for a plain axis without one
};

struct Block {
  std::string name;    ///< as the formula and the layout file call it: "drive"
  std::string module;  ///< "lambda"
  std::string plugin;  ///< id of the plugin the module came from
};

/// A number of the layout under its dotted name, points and lists flattened: "drive.base[0].x".
struct Parameter {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// A computed figure; one that could not be computed has no value but a reason.
struct Metric {
  std::string name;
  std::optional<double> value;
  std::string unit;
  std::string method;   ///< how it was computed, such as "grid 20x20x20"; one value is kept per
                        ///< name, unit and method
  std::string failure;  ///< why there is no value
};

struct Capability {
  std::string name;  ///< "milling"
  std::string detail;
};

struct Calibration {
  std::string measurements;         ///< the measurement file as the user named it
  std::string measurements_sha256;  ///< 64 hex digits
  std::string status;               ///< "converged", "rank deficient" ...
  std::optional<double> rms_before_um;
  std::optional<double> rms_after_um;
  std::optional<double> sigma_um;       ///< estimated standard deviation of one measurement
  std::int64_t degrees_of_freedom = 0;  ///< equations less identified parameters
  std::string report_json = "{}";       ///< the whole report, JSON text
};

/// One layout with whatever is known about it.
///
/// Two records are the same layout if `name`, `formula`, `blocks`, `parameters` and `content` are
/// equal: these make the content hash. Everything else either follows from them or is a result
/// about them.
struct LayoutRecord {
  std::string name;
  std::string formula;          ///< canonical text
  std::string distribution;     ///< key of the formula's distribution class
  std::string relative_motion;  ///< key of its relative-motion class
  bool open_base = false;
  int coordinates = 0;  ///< virtual coordinates
  int drives = 0;
  std::vector<Motion> motions;
  std::vector<Block> blocks;
  std::vector<Parameter> parameters;
  std::string toml;     ///< the layout file's text; given back unchanged by `Store::Export`
  std::string content;  ///< the file's meaning without comments and spacing; empty: `toml` itself,
                        ///< line ends normalised
  std::vector<Metric> metrics;
  std::vector<Capability> capabilities;
  std::vector<Calibration> calibrations;
  Provenance provenance;
};

/// A layout as the catalog holds it.
struct StoredLayout {
  std::int64_t id = 0;
  std::string hash;                     ///< content hash, 64 hex digits
  std::string added_at;                 ///< UTC, "2025-03-01T12:00:00Z"
  std::optional<double> rms_before_um;  ///< of the newest calibration that has residuals
  std::optional<double> rms_after_um;
  LayoutRecord record;
};

/// Everything that makes `record` unfit for the catalog (E0511); empty if nothing does.
[[nodiscard]] Diagnostics Check(const LayoutRecord& record);

/// The content hash, 64 hex digits.
[[nodiscard]] std::string ContentHash(const LayoutRecord& record);

/// The whole entry, members in reading order, `toml` included.
[[nodiscard]] nlohmann::ordered_json ToJson(const StoredLayout& layout);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_RECORD_HPP_
