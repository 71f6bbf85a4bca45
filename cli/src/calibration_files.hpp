// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CALIBRATION_FILES_HPP_
#define KOMPONO_CLI_CALIBRATION_FILES_HPP_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kompono/calibration/measurements.hpp"
#include "kompono/catalog/record.hpp"
#include "kompono/diagnostics/diagnostic.hpp"

/// What passes from measurement files through `kompono calibrate` into the catalog.
namespace kompono::cli {

/// A file to read, and what is to be said of its rows.
struct MeasurementSource {
  std::string name;
  std::optional<double> sigma_mm, sigma_rad;  ///< of rows without their own
  bool held_out = false;                      ///< all its rows
};

struct MeasurementFile {
  std::string name;  ///< as the user named it
  std::string sha256;
};

struct MeasurementFiles {
  std::vector<MeasurementFile> files;
  calibration::MeasurementSet set;  ///< of all of them
};

/// All problems of all files. Rows of several files are counted through and have no line.
[[nodiscard]] Parsed<MeasurementFiles> ReadMeasurementFiles(
    const std::vector<MeasurementSource>& sources,
    const kinematics::Machine& machine,
    const calibration::ReadOptions& options,
    Diagnostics& notes);

/// What a calibrated layout says of its origin: "points.csv (sha256 ...)".
[[nodiscard]] std::string SourceText(const MeasurementFiles& files);

/// A calibration for the catalog from what a calibrated layout says in its [calibrated] table;
/// nothing if it has none.
[[nodiscard]] std::optional<catalog::Calibration> CalibrationOfLayout(std::string_view toml);

/// The same from the report file of `kompono calibrate --report`. RMS are over all measured lengths
/// of the fitted rows. E0617 if it is no such report.
[[nodiscard]] Parsed<catalog::Calibration> CalibrationOfReport(std::string_view text,
                                                               const std::string& file);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CALIBRATION_FILES_HPP_
