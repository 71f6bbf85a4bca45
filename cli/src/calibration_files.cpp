// SPDX-License-Identifier: Apache-2.0
#include "calibration_files.hpp"

#include "codes.hpp"
#include "files.hpp"
#include "text.hpp"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include <toml++/toml.h>

#include "kompono/catalog/hash.hpp"

namespace kompono::cli {
namespace {

constexpr std::string_view kDigestMark = " (sha256 ";
constexpr std::size_t kDigestLength = 64;
constexpr double kMicrometresPerMm = 1000.0;

/// Where the fixtures of a further file stand in those of all: of the same kind and name is the
/// same, and known if any file knows it.
std::vector<int> Merge(const std::vector<calibration::Fixture>& part,
                       std::vector<calibration::Fixture>& all) {
  std::vector<int> indices;
  for (const calibration::Fixture& fixture : part) {
    const auto same = std::find_if(all.begin(), all.end(), [&fixture](const auto& other) {
      return other.kind == fixture.kind && other.name == fixture.name;
    });
    indices.push_back(static_cast<int>(same - all.begin()));
    if (same == all.end()) {
      all.push_back(fixture);
    } else if (fixture.known && !same->known) {
      *same = fixture;
    }
  }
  return indices;
}

void Append(calibration::MeasurementSet part, bool first, calibration::MeasurementSet& set) {
  if (first) {
    set = std::move(part);
    return;
  }
  // Rows of several files: neither their texts nor their lines go together.
  set.file += ", " + part.file;
  set.text.clear();
  const std::vector<int> fixtures = Merge(part.fixtures, set.fixtures);
  for (calibration::Measurement& row : part.measurements) {
    if (row.target >= 0) row.target = fixtures[static_cast<std::size_t>(row.target)];
    if (row.fixture >= 0) row.fixture = fixtures[static_cast<std::size_t>(row.fixture)];
    set.measurements.push_back(std::move(row));
  }
  for (std::size_t i = 0; i < set.measurements.size(); ++i) {
    set.measurements[i].row = static_cast<int>(i) + 1;
    set.measurements[i].line = 0;
  }
  for (std::string& pattern : part.suggested_free) set.suggested_free.push_back(std::move(pattern));
  set.relative_weights = set.relative_weights || part.relative_weights;
  if (set.origin != part.origin) set.origin.clear();
}

/// Joint name and digest: of the file itself if there is one, else of the digests in a row.
catalog::Calibration Named(const std::vector<MeasurementFile>& files) {
  catalog::Calibration out;
  std::string digests;
  for (const MeasurementFile& file : files) {
    out.measurements += (out.measurements.empty() ? "" : ", ") + file.name;
    digests += file.sha256;
  }
  out.measurements_sha256 = files.size() == 1 ? digests : catalog::Hex(catalog::Sha256Of(digests));
  return out;
}

Diagnostics NoReport(const std::string& file, std::string message) {
  return {{.code = std::string(codes::kBadJson.code),
           .file = file,
           .message = std::move(message),
           .help = "reports are written by kompono calibrate --report"}};
}

/// RMS over the rows of all lengths, µm.
std::optional<double> PooledRms(const nlohmann::json& errors, const std::string& key) {
  double squares = 0.0;
  double count = 0.0;
  for (const nlohmann::json& entry : errors) {
    if (!entry.contains(key) || entry.value("held_out", false)) continue;
    const double rms = entry.at(key).get<double>();
    const double rows = entry.at("count").get<double>();
    squares += rows * rms * rms;
    count += rows;
  }
  if (count == 0.0) return std::nullopt;
  return std::sqrt(squares / count) * kMicrometresPerMm;
}

}  // namespace

Parsed<MeasurementFiles> ReadMeasurementFiles(const std::vector<MeasurementSource>& sources,
                                              const kinematics::Machine& machine,
                                              const calibration::ReadOptions& options,
                                              Diagnostics& notes) {
  MeasurementFiles out;
  Diagnostics problems;
  const auto complain = [&problems](const Diagnostics& more) {
    problems.insert(problems.end(), more.begin(), more.end());
  };
  for (const MeasurementSource& source : sources) {
    const std::string& name = source.name;
    const Parsed<std::string> text = ReadWhole(name);
    if (!text) {
      complain(text.error());
      continue;
    }
    Parsed<calibration::MeasurementSet> set =
        calibration::ParseMeasurements(*text, name, machine, options, &notes);
    if (!set) {
      complain(set.error());
      continue;
    }
    for (calibration::Measurement& row : set->measurements) {
      if (!row.sigma_mm) row.sigma_mm = source.sigma_mm;
      if (!row.sigma_rad) row.sigma_rad = source.sigma_rad;
      row.held_out = row.held_out || source.held_out;
    }
    Append(std::move(*set), out.files.empty(), out.set);
    out.files.push_back({.name = name, .sha256 = catalog::Hex(catalog::Sha256Of(*text))});
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return out;
}

std::string SourceText(const MeasurementFiles& files) {
  const catalog::Calibration named = Named(files.files);
  return fmt::format("{}{}{})", named.measurements, kDigestMark, named.measurements_sha256);
}

std::optional<catalog::Calibration> CalibrationOfLayout(std::string_view toml) {
  const toml::table table = toml::parse(toml);  // it has been read as a layout before
  const std::optional<std::string> source = table["calibrated"]["source"].value<std::string>();
  if (!source) return std::nullopt;
  const std::size_t mark = source->rfind(kDigestMark);
  if (mark == std::string::npos) return std::nullopt;
  catalog::Calibration out;
  out.measurements = source->substr(0, mark);
  out.measurements_sha256 = source->substr(mark + kDigestMark.size(), kDigestLength);
  out.status = "calibrated";
  if (!catalog::Sha256FromHex(out.measurements_sha256)) return std::nullopt;
  return out;
}

Parsed<catalog::Calibration> CalibrationOfReport(std::string_view text, const std::string& file) {
  const nlohmann::json report = nlohmann::json::parse(text, nullptr, false);
  if (!report.is_object()) return tl::unexpected(NoReport(file, "no JSON object"));
  try {
    std::vector<MeasurementFile> files;
    for (const nlohmann::json& entry : report.at("measurements"))
      files.push_back({.name = entry.at("file"), .sha256 = entry.at("sha256")});
    catalog::Calibration out = Named(files);
    out.status = report.at("status").get<std::string>();
    out.rms_before_um = PooledRms(report.at("errors"), "rms_before_mm");
    out.rms_after_um = PooledRms(report.at("errors"), "rms_after_mm");
    out.degrees_of_freedom = report.at("dof").get<std::int64_t>();
    out.report_json = report.dump();
    return out;
  } catch (const nlohmann::json::exception& error) {
    return tl::unexpected(
        NoReport(file, fmt::format("no report of an identification: {}", error.what())));
  }
}

}  // namespace kompono::cli
