// SPDX-License-Identifier: Apache-2.0
#include "library.hpp"

#include "elf_extent.hpp"
#include "manifest.hpp"
#include "path_safety.hpp"
#include "processor.hpp"
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <typeinfo>
#include <utility>
#include <vector>

#include <boost/dll/shared_library.hpp>

namespace kompono::plugin {
namespace {

constexpr const char* kSymbol = "kompono_plugin";

std::terminate_handler previous_terminate = nullptr;
thread_local const char* library_being_opened = nullptr;

/// The interfaces' type information lives in the contract's library. Naming it here keeps the
/// linker from dropping that library from a program that makes modules only through plugins; they
/// then find it already there and need no path to it, wherever they are installed.
const std::type_info* volatile const kInterfaceTypes[] = {&typeid(Mechanism), &typeid(Unit)};

/// An exception out of a static constructor cannot be stopped, but it can be said whose it was.
[[noreturn]] void NameTheLibrary() {
  if (library_being_opened != nullptr) {
    std::fprintf(stderr,
                 "kompono: the plugin library %s ended the program while it was being opened; a "
                 "static object of it threw.\nMove its folder out of the plugin folders.\n",
                 library_being_opened);
  }
  if (previous_terminate != nullptr) previous_terminate();
  std::abort();
}

class OpeningNotice {
 public:
  explicit OpeningNotice(const std::string& path) : lock_(Mutex()) {
    library_being_opened = path.c_str();
    previous_terminate = std::set_terminate(&NameTheLibrary);
  }
  OpeningNotice(const OpeningNotice&) = delete;
  OpeningNotice& operator=(const OpeningNotice&) = delete;
  ~OpeningNotice() {
    std::set_terminate(previous_terminate);
    library_being_opened = nullptr;
  }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
};

Diagnostic Refused(const std::string& path, Refusal refusal) {
  return {.code = std::move(refusal.code),
          .file = path,
          .message = std::move(refusal.message),
          .help = std::move(refusal.help)};
}

Diagnostic CannotOpen(const std::string& path, std::string_view why) {
  return {
      .code = CodeOf(LoadError::kCannotOpen),
      .file = path,
      .message = fmt::format("the library cannot be opened: {}", why),
      .help = "build or install the plugin again, or move its folder out of the plugin folders"};
}

/// The system's words without the path they begin with, which the diagnostic names anyway.
std::string SystemText(const std::string& path) {
  const char* const text = dlerror();
  std::string_view words = text == nullptr ? "no reason was given" : text;
  if (words.starts_with(path + ": ")) words.remove_prefix(path.size() + 2);
  return std::string(words);
}

}  // namespace

struct Library::Handle {
  boost::dll::shared_library library;
};

Library::Library() : handle_(std::make_unique<Handle>()) {}
Library::~Library() = default;

tl::expected<std::shared_ptr<const Library>, Diagnostic> Library::Open(
    const PluginDescription& plugin) {
  std::error_code error;
  const std::filesystem::path file = BestForThisProcessor(
      std::filesystem::absolute(plugin.sidecar, error).parent_path(), plugin.library);
  const std::string path = file.string();
  if (auto unsafe = JudgePath(file)) return tl::unexpected(std::move(*unsafe));
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    return tl::unexpected(CannotOpen(path, "it is not a file"));
  if (const std::string missing = MissingBytes(file); !missing.empty())
    return tl::unexpected(CannotOpen(path, missing));

  const std::shared_ptr<Library> library(new Library());
  library->path_ = path;
  boost::dll::shared_library& handle = library->handle_->library;
  {
    const OpeningNotice notice(path);
    std::error_code ignored;  // Boost 1.74 says "Bad file descriptor" whatever happened
    dlerror();
    // What a static constructor throws must not unwind through the loader, which would leave the
    // library half open.
    [&]() noexcept {
      handle.load(
          file, ignored, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
    }();
    if (!handle.is_loaded()) return tl::unexpected(CannotOpen(path, SystemText(path)));
  }
  if (!handle.has(kSymbol))
    return tl::unexpected(Refused(path,
                                  {CodeOf(LoadError::kNotAPlugin),
                                   fmt::format("the library has no symbol '{}'", kSymbol),
                                   "make it with KOMPONO_PLUGIN of the SDK"}));
  library->manifest_ = &handle.get<const KomponoPlugin>(kSymbol);
  if (auto refusal = JudgeManifest(*library->manifest_, plugin))
    return tl::unexpected(Refused(path, std::move(*refusal)));
  if (library->manifest_->toolchain.compiler != nullptr)
    library->compiler_ = library->manifest_->toolchain.compiler;
  return library;
}

void* Library::Make(const KomponoModule& entry, std::string& reason) {
  std::array<char, 512> buffer{};
  void* made = nullptr;
  // The contract lets no exception out; one that comes all the same must not outlive the library.
  try {
    made = entry.create(buffer.data(), buffer.size());
    buffer.back() = '\0';
    reason = buffer.data();
  } catch (const std::exception& thrown) {
    reason = fmt::format("it threw: {}", thrown.what());
  } catch (...) {
    reason = "it threw something that is no std::exception";
  }
  return made;
}

template <class Interface>
tl::expected<std::shared_ptr<Interface>, Diagnostic> Library::Object(
    const std::shared_ptr<const Library>& library, const KomponoModule& entry) {
  std::string reason;
  void* const made = Make(entry, reason);
  if (made == nullptr) {
    return tl::unexpected(
        Refused(library->path_,
                {CodeOf(LoadError::kCreateFailed),
                 fmt::format("module '{}' could not be created: {}",
                             entry.id,
                             reason.empty() ? "the plugin gave no reason" : reason),
                 ""}));
  }
  return std::shared_ptr<Interface>(
      static_cast<Interface*>(made),
      [destroy = entry.destroy, keep_mapped = library](Interface* p) { destroy(p); });
}

template <class Interface>
tl::expected<std::shared_ptr<const Interface>, Diagnostic> Library::Create(
    const std::shared_ptr<const Library>& library, const ModuleDescription& module) {
  // JudgeManifest saw that it is there.
  const KomponoModule& entry =
      *FindEntry(*library->manifest_, module.id, MainInterface(module.kind));
  auto object = Object<Interface>(library, entry);
  if (!object) return tl::unexpected(std::move(object.error()));
  if (auto refusal = JudgeShape((*object)->Shape(), module))
    return tl::unexpected(Refused(library->path_, std::move(*refusal)));
  return std::shared_ptr<const Interface>(std::move(*object));
}

tl::expected<std::shared_ptr<const BoundMechanism>, Diagnostic> Library::CreateBound(
    const std::shared_ptr<const Library>& library,
    const ModuleDescription& module,
    std::span<const double> parameters,
    std::span<const double> modes) {
  const KomponoModule* entry =
      FindEntry(*library->manifest_, module.id, KOMPONO_BOUND_MECHANISM_INTERFACE);
  if (entry == nullptr) {
    return tl::unexpected(Refused(
        library->path_,
        {CodeOf(LoadError::kCreateFailed),
         fmt::format("module '{}' does not offer {}", module.id, KOMPONO_BOUND_MECHANISM_INTERFACE),
         "ask it through kompono.mechanism/1, which every mechanism offers"}));
  }
  auto object = Object<BoundMechanism>(library, *entry);
  if (!object) return tl::unexpected(std::move(object.error()));
  if ((*object)->Bind(parameters, modes) != Status::kOk) {
    return tl::unexpected(
        Refused(library->path_,
                {CodeOf(LoadError::kCreateFailed),
                 fmt::format("module '{}' could not take {} parameters and {} modes",
                             module.id,
                             parameters.size(),
                             modes.size()),
                 "give as many as its sidecar says"}));
  }
  return std::shared_ptr<const BoundMechanism>(std::move(*object));
}

template tl::expected<std::shared_ptr<const Mechanism>, Diagnostic> Library::Create(
    const std::shared_ptr<const Library>& library, const ModuleDescription& module);
template tl::expected<std::shared_ptr<const Unit>, Diagnostic> Library::Create(
    const std::shared_ptr<const Library>& library, const ModuleDescription& module);

}  // namespace kompono::plugin
