// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_CAMPAIGN_HPP_
#define KOMPONO_CLI_CAMPAIGN_HPP_

#include "calibration_files.hpp"

#include <string>
#include <string_view>
#include <vector>

#include "kompono/diagnostics/diagnostic.hpp"

/// A measurement description: which files were measured on which layout, and how to fit them.
///
///     measurements = 1
///     layout = "../machines/so_waterjet_lambda.toml"      # beside this file
///
///     [[file]]
///     csv = "holes.csv"
///     sigma_mm = 0.02          # of rows without their own
///     held_out = false         # true: all its rows judge only
///
///     [fit]
///     free = ["drive.*"]       # lock and group likewise
///     prior = { "drive.L1" = 0.05 }
namespace kompono::cli {

struct Campaign {
  std::string layout;
  std::vector<MeasurementSource> files;
  std::vector<std::string> free, lock, groups;
  std::vector<std::string> prior;  ///< "pattern=number", mm or deg
};

/// Whether a TOML file is such a description and no layout: it has a key "measurements".
[[nodiscard]] bool IsCampaign(std::string_view text);

/// Names of files become relative to the description's folder. E0468 for all that is wrong.
[[nodiscard]] Parsed<Campaign> ReadCampaign(std::string_view text, const std::string& file);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_CAMPAIGN_HPP_
