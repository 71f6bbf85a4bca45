// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_PLUGIN_HOST_ELF_EXTENT_HPP_
#define KOMPONO_PLUGIN_HOST_ELF_EXTENT_HPP_

#include <filesystem>
#include <string>

namespace kompono::plugin {

/// Opening a library whose end is cut off (a full disk, a broken copy) ends the program with
/// SIGBUS inside the dynamic loader, so its extent is checked before. Empty if the file has all the
/// bytes its program headers speak of, or is none of this machine's libraries, which the dynamic
/// loader refuses by itself; else what is wrong.
[[nodiscard]] std::string MissingBytes(const std::filesystem::path& library);

}  // namespace kompono::plugin

#endif  // KOMPONO_PLUGIN_HOST_ELF_EXTENT_HPP_
