#include "mansard/formats/attribute_choice.hpp"

#include <algorithm>

namespace mansard::formats {

auto name_presets() -> const std::vector<NamePreset>& {
  // The names of both are those of published files: 3DBAG of 2023 to 2025 (3dbag.nl), and the defaults of roofer 1.0
  // (github.com/3DBAG/roofer, its options --a-…). What neither has is left out.
  static const std::vector<NamePreset> all{
      {"3dbag",
       "The names of 3DBAG.",
       "attributes of the 3DBAG, https://docs.3dbag.nl",
       {{"ms_success", "b3_succes"},
        {"ms_h_ground", "b3_h_maaiveld"},
        {"ms_h_roof_min", "b3_h_dak_min"},
        {"ms_h_roof_50p", "b3_h_dak_50p"},
        {"ms_h_roof_70p", "b3_h_dak_70p"},
        {"ms_h_roof_max", "b3_h_dak_max"},
        {"ms_h_ridge", "b3_h_nok"},
        {"ms_roof_type", "b3_dak_type"},
        {"ms_roof_planes", "b3_n_vlakken"},
        {"ms_ridges", "b3_n_nok"},
        {"ms_area_ground", "b3_opp_grond"},
        {"ms_area_roof_flat", "b3_opp_dak_plat"},
        {"ms_area_roof_sloped", "b3_opp_dak_schuin"},
        {"ms_area_wall", "b3_opp_buitenmuur"},
        {"ms_area_party_wall", "b3_opp_scheidingsmuur"},
        {"ms_storeys", "b3_bouwlagen"},
        {"ms_volume_lod12", "b3_volume_lod12"},
        {"ms_volume_lod13", "b3_volume_lod13"},
        {"ms_volume_lod22", "b3_volume_lod22"},
        {"ms_rmse_lod12", "b3_rmse_lod12"},
        {"ms_rmse_lod13", "b3_rmse_lod13"},
        {"ms_rmse_lod22", "b3_rmse_lod22"},
        {"ms_val3dity_lod12", "b3_val3dity_lod12"},
        {"ms_val3dity_lod13", "b3_val3dity_lod13"},
        {"ms_val3dity_lod22", "b3_val3dity_lod22"},
        {"ms_nodata_share", "b3_nodata_fractie"},
        {"ms_nodata_radius", "b3_nodata_radius"},
        {"ms_point_density", "b3_puntdichtheid"},
        {"ms_source", "b3_pw_bron"},
        {"ms_source_date", "b3_pw_datum"}}},
      {"roofer",
       "The default names of roofer.",
       "the defaults of roofer's options a_success to a_extrusion_mode, https://github.com/3DBAG/roofer",
       {{"ms_success", "rf_success"},
        {"ms_h_ground", "rf_h_ground"},
        {"ms_h_roof_min", "rf_h_roof_min"},
        {"ms_h_roof_50p", "rf_h_roof_50p"},
        {"ms_h_roof_70p", "rf_h_roof_70p"},
        {"ms_h_roof_max", "rf_h_roof_max"},
        {"ms_h_ridge", "rf_h_roof_ridge"},
        {"ms_roof_type", "rf_roof_type"},
        {"ms_roof_planes", "rf_roof_planes"},
        {"ms_ridges", "rf_ridgelines"},
        {"ms_volume_lod12", "rf_volume_lod12"},
        {"ms_volume_lod13", "rf_volume_lod13"},
        {"ms_volume_lod22", "rf_volume_lod22"},
        {"ms_rmse_lod12", "rf_rmse_lod12"},
        {"ms_rmse_lod13", "rf_rmse_lod13"},
        {"ms_rmse_lod22", "rf_rmse_lod22"},
        {"ms_val3dity_lod12", "rf_val3dity_lod12"},
        {"ms_val3dity_lod13", "rf_val3dity_lod13"},
        {"ms_val3dity_lod22", "rf_val3dity_lod22"},
        {"ms_nodata_share", "rf_nodata_frac"},
        {"ms_nodata_radius", "rf_nodata_r"},
        {"ms_point_density", "rf_pt_density"},
        {"ms_source", "rf_pc_source"},
        {"ms_source_date", "rf_pc_year"}}}};
  return all;
}

auto is_computed(std::string_view name) -> bool {
  return name.starts_with("ms_") || name == "measuredHeight" || name == "roofType" || name == "storeysAboveGround";
}

auto AttributeChoice::of(std::string_view text) -> base::Result<AttributeChoice> {
  AttributeChoice out;
  if (text.empty() || text == "all") return out;
  out.all_ = false;
  if (text == "none") return out;
  for (const auto& preset : name_presets())
    if (text == preset.name) {
      for (const auto& [from, to] : preset.names) out.names_.emplace_back(from, to);
      return out;
    }
  const auto wrong = [](const std::string& what) {
    return base::error("option-value",
                       what +
                           "; expected 'all', 'none', '3dbag', 'roofer' or a list such as "
                           "'ms_h_ground,ms_h_roof_max=top'; 'mansard options --attributes' lists the names",
                       "write.attributes");
  };
  while (!text.empty()) {
    const auto comma = text.find(',');
    auto word = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
    while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
    while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
    const auto equals = word.find('=');
    const std::string name(word.substr(0, equals));
    const std::string to(equals == std::string_view::npos ? word : word.substr(equals + 1));
    if (!is_computed(name)) return wrong("'" + name + "' is not an attribute that mansard computes");
    if (to.empty()) return wrong("'" + std::string(word) + "' has no new name");
    for (const auto& [other, other_to] : out.names_)
      if (other == name || other_to == to) return wrong("'" + std::string(word) + "' is given twice");
    out.names_.emplace_back(name, to);
    out.list_ = true;
  }
  return out;
}

auto AttributeChoice::listed() const -> std::vector<std::string> {
  std::vector<std::string> out;
  for (const auto& [name, to] : names_)
    if (list_) out.push_back(name);
  return out;
}

auto AttributeChoice::chosen(const model::Attributes& attributes) const -> model::Attributes {
  if (all_) return attributes;
  model::Attributes out;
  for (const auto& [name, value] : attributes) {
    if (!is_computed(name)) {
      out.emplace_back(name, value);
      continue;
    }
    const auto found = std::ranges::find(names_, name, &std::pair<std::string, std::string>::first);
    if (found != names_.end()) out.emplace_back(found->second, value);
  }
  return out;
}

}  // namespace mansard::formats
