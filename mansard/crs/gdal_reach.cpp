#include "mansard/crs/gdal_reach.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>

namespace mansard::crs {
namespace {

namespace fs = std::filesystem;

thread_local GdalReach* current_reach = nullptr;

/// No limits for what a file system reads for itself, such as the keys of a user for a server.
class Aside {
 public:
  Aside() : reach_(std::exchange(current_reach, nullptr)) {}
  Aside(const Aside&) = delete;
  auto operator=(const Aside&) -> Aside& = delete;
  ~Aside() { current_reach = reach_; }

 private:
  GdalReach* reach_;
};

/// GDAL's own files: definitions of formats, registers.
auto data_folder() -> const std::string& {
  static const std::string folder = [] {
    const char* found = CPLFindFile("gdal", "gdalvrt.xsd");
    return found == nullptr ? std::string() : fs::path(found).parent_path().string();
  }();
  return folder;
}

auto temporary_folder() -> std::string {
  for (const char* name : {"CPL_TMPDIR", "TMPDIR", "TEMP"})
    if (const char* folder = CPLGetConfigOption(name, nullptr)) return folder;
  return ".";
}

auto is_in(const std::string& name, const std::string& folder) -> bool {
  return !folder.empty() && fs::path(name).lexically_normal().parent_path() == fs::path(folder).lexically_normal();
}

/// One of GDAL's file systems, asked only for what may be opened. It forwards what reading needs; what it does not, the
/// library's base class does as for a file system without it.
class ReachedFiles : public VSIFilesystemHandler {
 public:
  ReachedFiles(VSIFilesystemHandler* behind, bool local) : behind_(behind), local_(local) {}
  ReachedFiles(const ReachedFiles&) = delete;
  auto operator=(const ReachedFiles&) -> ReachedFiles& = delete;
  ~ReachedFiles() override { delete behind_; }  // NOLINT: VSIFileManager deletes handlers, and this one took its place

  // GDAL 3.12 returns another kind of pointer.
  using Opened = decltype(std::declval<VSIFilesystemHandler&>().Open("", "", false, nullptr));
  auto Open(const char* name, const char* access, bool set_error, CSLConstList options) -> Opened override {
    const std::string_view how = access;
    if (!passes(name, how.find_first_of("wa+") != how.npos)) {
      errno = ENOENT;
      return {};
    }
    const Aside aside;
    return behind_->Open(name, access, set_error, options);
  }
  auto Stat(const char* name, VSIStatBufL* status, int flags) -> int override {
    if (!passes(name, false)) {
      errno = ENOENT;
      return -1;
    }
    const Aside aside;
    return behind_->Stat(name, status, flags);
  }
  auto ReadDirEx(const char* name, int most) -> char** override {
    if (current_reach != nullptr && !current_reach->opens((fs::path(name) / "x").string(), false)) return nullptr;
    const Aside aside;
    return behind_->ReadDirEx(name, most);
  }
  auto OpenDir(const char* name, int depth, const char* const* options) -> VSIDIR* override {
    if (current_reach != nullptr && !current_reach->opens((fs::path(name) / "x").string(), false)) return nullptr;
    const Aside aside;
    return behind_->OpenDir(name, depth, options);
  }
  auto Unlink(const char* name) -> int override { return changes(name) ? behind_->Unlink(name) : -1; }
  auto Mkdir(const char* name, long mode) -> int override { return changes(name) ? behind_->Mkdir(name, mode) : -1; }
  auto Rmdir(const char* name) -> int override { return changes(name) ? behind_->Rmdir(name) : -1; }
  auto Rename(const char* from, const char* to) -> int override {
    return changes(from) && changes(to) ? behind_->Rename(from, to) : -1;
  }
  auto SiblingFiles(const char* name) -> char** override { return behind_->SiblingFiles(name); }
  auto IsCaseSensitive(const char* name) -> int override { return behind_->IsCaseSensitive(name); }
  auto GetDiskFreeSpace(const char* name) -> GIntBig override { return behind_->GetDiskFreeSpace(name); }
  auto SupportsSparseFiles(const char* name) -> int override { return behind_->SupportsSparseFiles(name); }
  auto HasOptimizedReadMultiRange(const char* name) -> int override {
    return behind_->HasOptimizedReadMultiRange(name);
  }
  auto GetActualURL(const char* name) -> const char* override { return behind_->GetActualURL(name); }
  auto GetOptions() -> const char* override { return behind_->GetOptions(); }
  auto GetStreamingFilename(const std::string& name) const -> std::string override {
    return behind_->GetStreamingFilename(name);
  }
  auto IsLocal(const char* name) -> bool override { return behind_->IsLocal(name); }
  auto SupportsSequentialWrite(const char* name, bool temporary) -> bool override {
    return behind_->SupportsSequentialWrite(name, temporary);
  }
  auto SupportsRandomWrite(const char* name, bool temporary) -> bool override {
    return behind_->SupportsRandomWrite(name, temporary);
  }
  auto SupportsRead(const char* name) -> bool override { return behind_->SupportsRead(name); }

 private:
  [[nodiscard]] auto passes(const char* name, bool writes) const -> bool {
    if (current_reach == nullptr || current_reach->opens(name, writes)) return true;
    // A driver looks for many files that no one has: a name that leads to no file is no reference.
    VSIStatBufL status;
    if (!local_ || (behind_->Stat(name, &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0 &&
                    VSI_ISDIR(status.st_mode) == 0))
      current_reach->refuse(name);
    return false;
  }
  /// While a file is read, only what GDAL made for that is changed.
  [[nodiscard]] static auto changes(const char* name) -> bool {
    if (current_reach == nullptr || current_reach->opens(name, true)) return true;
    errno = EACCES;
    return false;
  }

  VSIFilesystemHandler* behind_;
  bool local_;
};

using Opener = GDALDataset* (*)(GDALOpenInfo*);

auto openers() -> std::map<const GDALDriver*, Opener>& {
  static std::map<const GDALDriver*, Opener> all;
  return all;
}

/// "PG:host=…", "NETCDF:…", "MEM:::…": a driver's own words for something that is no file.
auto is_connection(const GDALOpenInfo& info) -> bool {
  if (info.bStatOK != 0 || info.fpL != nullptr || info.nHeaderBytes > 0) return false;
  const std::string_view name = info.pszFilename;
  const auto end = name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-");
  return end != name.npos && end > 0 && name[end] == ':';
}

auto open_in_reach(GDALDriver* driver, GDALOpenInfo* info) -> GDALDataset* {
  if (current_reach != nullptr && is_connection(*info) && !current_reach->is_given(info->pszFilename)) {
    current_reach->refuse(info->pszFilename);
    return nullptr;
  }
  const auto found = openers().find(driver);
  return found == openers().end() ? nullptr : found->second(info);
}

}  // namespace

GdalReach::GdalReach(std::string given, May may)
    : given_(std::move(given)), may_(std::move(may)), outer_(std::exchange(current_reach, this)) {}

GdalReach::~GdalReach() { current_reach = outer_; }

auto GdalReach::current() -> GdalReach* { return current_reach; }

auto GdalReach::opens(const std::string& name, bool writes) -> bool {
  if (made_.contains(name)) return true;
  if (writes) return is_in(name, temporary_folder()) && made_.insert(name).second;
  return is_given(name) || is_in(name, data_folder()) || may_(name);
}

void GdalReach::refuse(const std::string& name) {
  // What GDAL asks the system is no reference of a file.
  if (!refused_ && !name.starts_with("/proc/") && !name.starts_with("/sys/")) refused_ = name;
}

void confine_gdal() {
  (void)data_folder();
  // The disk, and what is neither on it nor in memory: https://gdal.org/user/virtual_file_systems.html
  constexpr std::array<std::string_view, 4> harmless{"/vsimem/", "/vsisubfile/", "/vsisparse/", "/vsicached"};
  constexpr std::array<std::string_view, 4> archives{"/vsizip/", "/vsitar/", "/vsigzip/", "/vsicrypt/"};
  const auto leads_to_disk = [&](std::string_view prefix) {
    return std::ranges::find(harmless, prefix) != harmless.end() ||
           std::ranges::find(archives, prefix) != archives.end();
  };
  VSIFileManager::InstallHandler("", new ReachedFiles(VSIFileManager::GetHandler("."), true));
  CPLStringList prefixes(VSIFileManager::GetPrefixes());
  prefixes.AddString("/vsicurl?");                      // which GDAL does not list
  std::map<VSIFilesystemHandler*, ReachedFiles*> made;  // some have two prefixes
  for (int i = 0; i < prefixes.Count(); ++i) {
    if (leads_to_disk(prefixes[i])) continue;
    VSIFilesystemHandler* behind = VSIFileManager::GetHandler(prefixes[i]);
    if (behind == VSIFileManager::GetHandler(".")) continue;  // GDAL was built without it
    auto& asking = made[behind];
    if (asking == nullptr) asking = new ReachedFiles(behind, false);
    VSIFileManager::InstallHandler(prefixes[i], asking);
  }

  GDALDriverManager& drivers = *GetGDALDriverManager();
  for (int i = 0; i < drivers.GetDriverCount(); ++i) {
    GDALDriver& driver = *drivers.GetDriver(i);
    if (driver.pfnOpen == nullptr) continue;
    openers().emplace(&driver, driver.pfnOpen);
    driver.pfnOpen = nullptr;
    driver.pfnOpenWithDriverArg = &open_in_reach;
  }
}

}  // namespace mansard::crs
