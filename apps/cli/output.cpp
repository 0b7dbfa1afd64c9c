#include "apps/cli/output.hpp"

#include "mansard/base/files.hpp"

namespace mansard::cli {

namespace fs = std::filesystem;

auto prepare(const fs::path& folder, bool overwrite) -> base::Result<void> {
  std::error_code status;
  if (fs::exists(folder, status)) {
    if (!fs::is_directory(folder, status))
      return base::error("output-exists", "this is a file, and the output is a folder; choose another name", folder.string());
    if (!overwrite && !fs::is_empty(folder, status))
      return base::error("output-exists", "the folder is not empty; choose another, or say --overwrite", folder.string());
  } else {
    fs::create_directories(folder, status);
    if (status)
      return base::error("file-write", "cannot make this folder: " + status.message() + "; choose a place that can be written",
                         folder.string());
  }
  const auto probe = folder / ".mansard-probe";
  if (auto written = base::write_file(probe, ""); !written)
    return base::error("file-write", "cannot write into this folder; choose a place that can be written", folder.string());
  fs::remove(probe, status);
  return {};
}

auto model_files(const write::City& city) -> base::Result<std::vector<std::pair<std::string, std::string>>> {
  std::vector<std::pair<std::string, std::string>> files;
  auto cityjson = write::cityjson(city);
  if (!cityjson) return cityjson.error();
  files.emplace_back("model.city.json", std::move(*cityjson));
  auto obj = write::obj(city, "model.mtl");
  if (!obj) return obj.error();
  files.emplace_back("model.obj", std::move(obj->obj));
  files.emplace_back("model.mtl", std::move(obj->mtl));
  auto glb = write::glb(city);
  if (!glb) return glb.error();
  files.emplace_back("model.glb", std::move(*glb));
  files.emplace_back("plans.json", write::plans(city));
  return files;
}

}  // namespace mansard::cli
