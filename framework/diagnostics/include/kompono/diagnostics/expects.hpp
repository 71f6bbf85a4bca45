// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_DIAGNOSTICS_EXPECTS_HPP_
#define KOMPONO_DIAGNOSTICS_EXPECTS_HPP_

#include <stdexcept>
#include <string>

/// A broken promise of the calling code (not of outside data) throws std::logic_error quoting the
/// condition.
#define KOMPONO_EXPECTS(condition)                                             \
  do {                                                                         \
    if (!(condition)) {                                                        \
      throw std::logic_error(std::string(__func__) + ": expects " #condition); \
    }                                                                          \
  } while (false)

#endif  // KOMPONO_DIAGNOSTICS_EXPECTS_HPP_
