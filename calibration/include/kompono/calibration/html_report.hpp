// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CALIBRATION_HTML_REPORT_HPP_
#define KOMPONO_CALIBRATION_HTML_REPORT_HPP_

#include <string>
#include <string_view>
#include <vector>

#include "kompono/calibration/identification.hpp"

namespace kompono::calibration {

/// What else is to be said, as text that keeps its lines.
struct PageSection {
  std::string title, text;
};

/// One page without outside parts: what was found in words, errors before and after as a table and
/// as a histogram, every row's error before and after, the numbers with their deviations, and what
/// cannot be told. `title`: machine and measurements; it is escaped.
[[nodiscard]] std::string RenderHtml(const CalibrationReport& report,
                                     std::string_view title,
                                     const std::vector<PageSection>& more = {});

}  // namespace kompono::calibration

#endif  // KOMPONO_CALIBRATION_HTML_REPORT_HPP_
