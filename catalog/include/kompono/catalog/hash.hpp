// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CATALOG_HASH_HPP_
#define KOMPONO_CATALOG_HASH_HPP_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kompono::catalog {

/// A SHA-256 digest (FIPS 180-4), computed by libcrypto.
using Sha256 = std::array<std::uint8_t, 32>;

[[nodiscard]] Sha256 Sha256Of(std::string_view bytes);

/// 64 lower-case hexadecimal digits.
[[nodiscard]] std::string Hex(const Sha256& digest);

/// The digest written by `Hex`, either letter case; nothing if `hex` is not 64 hexadecimal digits.
[[nodiscard]] std::optional<Sha256> Sha256FromHex(std::string_view hex);

}  // namespace kompono::catalog

#endif  // KOMPONO_CATALOG_HASH_HPP_
