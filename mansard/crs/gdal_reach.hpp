// What GDAL may open: files that it reads can name others, and drivers open many more than a caller sees.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>

namespace mansard::crs {

/// While it lives, GDAL opens in this thread only `given`, what `may` allows, its own data, and temporary files that it
/// made itself; nothing else is there for it. Names that are no files (connection strings, subdatasets) are not opened,
/// except `given` itself. They can be nested: the innermost decides. GDAL's other threads work on bytes, and open
/// nothing.
class GdalReach {
 public:
  using May = std::function<bool(const std::string& name)>;

  GdalReach(std::string given, May may);
  GdalReach(const GdalReach&) = delete;
  auto operator=(const GdalReach&) -> GdalReach& = delete;
  ~GdalReach();

  /// The first name that was refused and would have led to something: a file that exists, a server, a connection.
  [[nodiscard]] auto refused() const -> const std::optional<std::string>& { return refused_; }

  /// Of this thread; none where everything may be opened.
  [[nodiscard]] static auto current() -> GdalReach*;
  /// For a file, a server or a device, by GDAL's name; `writes` where it is to be made or changed.
  [[nodiscard]] auto opens(const std::string& name, bool writes) -> bool;
  [[nodiscard]] auto is_given(const std::string& name) const -> bool { return name == given_; }
  void refuse(const std::string& name);

 private:
  std::string given_;
  May may_;
  std::optional<std::string> refused_;
  std::set<std::string> made_;
  GdalReach* outer_;
};

/// Makes GDAL ask what it may open: once in the life of the program, after its drivers are registered.
void confine_gdal();

}  // namespace mansard::crs
