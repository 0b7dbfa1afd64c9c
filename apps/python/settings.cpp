#include "apps/python/settings.hpp"

#include <pybind11/stl.h>
#include <algorithm>
#include <cmath>

#include "apps/python/work.hpp"
#include "lab/simulate/simulate.hpp"
#include "mansard/compare/compare.hpp"
#include "mansard/edit/edit.hpp"
#include "mansard/formats/drivers.hpp"
#include "mansard/report/attributes.hpp"

namespace py = pybind11;

namespace mansard::python {
namespace {

auto keyword_of(const base::OptionList& list, const base::Option& option) -> std::string {
  return list.module() + "_" + option.name;
}

/// "module.name" of a keyword or an alias; empty where no option has it.
auto key_of(const std::vector<base::OptionList>& lists, const std::string& keyword) -> std::string {
  for (const auto& list : lists)
    for (const auto& option : list.options())
      if (keyword == keyword_of(list, option) || (!option.alias.empty() && keyword == option.alias))
        return list.module() + "." + option.name;
  return {};
}

auto unknown(const std::vector<base::OptionList>& lists, const std::string& keyword) -> base::Diagnostic {
  std::vector<std::string> known;
  for (const auto& list : lists)
    for (const auto& option : list.options()) {
      known.push_back(keyword_of(list, option));
      if (!option.alias.empty()) known.push_back(option.alias);
    }
  return base::error("option-unknown",
                     "there is no option '" + keyword + "'" + base::did_you_mean(base::nearest_word(keyword, known)) +
                         "; mansard.options() lists them",
                     keyword);
}

void add(py::list& all, const base::OptionList& list) {
  static constexpr std::array kinds{"flag", "integer", "number", "string", "choice"};
  for (const auto& option : list.options()) {
    py::dict entry;
    entry["keyword"] = keyword_of(list, option);
    entry["module"] = list.module();
    entry["name"] = option.name;
    entry["kind"] = kinds[static_cast<std::size_t>(option.kind)];
    entry["default"] = option.get();
    entry["unit"] = option.unit;
    entry["meaning"] = option.meaning;
    entry["minimum"] = std::isfinite(option.range.minimum) ? py::cast(option.range.minimum) : py::none();
    entry["maximum"] = std::isfinite(option.range.maximum) ? py::cast(option.range.maximum) : py::none();
    entry["choices"] = option.choices;
    entry["alias"] = option.alias;
    entry["source"] = option.source;
    entry["advanced"] = option.advanced;
    all.append(entry);
  }
}

auto option_table() -> py::list {
  py::list all;
  pipeline::Options options;
  for (const auto& list : pipeline::option_lists(options)) add(all, list);
  compare::Options of_compare;
  add(all, compare::option_list(of_compare));
  simulate::Options of_simulate;
  add(all, simulate::option_list(of_simulate));
  return all;
}

auto preset_table() -> py::list {
  py::list all;
  for (const auto& preset : pipeline::presets()) {
    py::dict entry, values;
    for (const auto& [key, value] : preset.values) values[py::str(key)] = value;
    entry["name"] = preset.name;
    entry["meaning"] = preset.meaning;
    entry["values"] = values;
    all.append(entry);
  }
  return all;
}

auto code_table() -> py::dict {
  py::dict all;
  auto codes = pipeline::codes();
  for (const auto& own : {edit::codes(), simulate::codes()}) codes.insert(codes.end(), own.begin(), own.end());
  for (const auto& code : codes) {
    py::dict entry;
    entry["cause"] = code.cause;
    entry["remedy"] = code.remedy;
    all[py::str(code.code)] = entry;
  }
  return all;
}

}  // namespace

void apply(std::vector<base::OptionList>& lists, const std::vector<pipeline::Preset>& presets,
           const std::string& preset, const Settings& settings) {
  std::vector<base::Diagnostic> wrong;
  const auto note = [&](const base::Result<void>& set, const std::string& where) {
    if (set) return;
    for (auto why : set.errors()) {
      why.subject = where;
      wrong.push_back(std::move(why));
    }
  };
  if (!preset.empty()) {
    const auto at = std::ranges::find(presets, preset, &pipeline::Preset::name);
    if (at == presets.end()) {
      std::string names;
      for (const auto& each : presets) names += (names.empty() ? "" : ", ") + each.name;
      wrong.push_back(base::error("option-value", "unknown preset '" + preset + "'; expected " + names, "preset"));
    } else {
      for (const auto& [key, value] : at->values) note(pipeline::set_option(lists, key, value), "preset");
    }
  }
  for (const auto& [keyword, value] : settings) {
    const auto key = key_of(lists, keyword);
    if (key.empty()) wrong.push_back(unknown(lists, keyword));
    else note(pipeline::set_option(lists, key, value), keyword);
  }
  if (!wrong.empty()) raise_error(wrong);
}

auto options_of(const std::string& preset, const Settings& settings) -> pipeline::Options {
  pipeline::Options options;
  auto lists = pipeline::option_lists(options);
  apply(lists, pipeline::presets(), preset, settings);
  return options;
}

void bind_settings(py::module_& m) {
  m.def("option_table", &option_table);
  m.def("preset_table", &preset_table);
  m.def("code_table", &code_table);
  m.def("limit_threads", &base::limit_threads, py::arg("threads"));
  m.def("formats", [] {
    py::list all;
    for (const auto& driver : formats::drivers()) {
      py::dict entry;
      entry["name"] = driver.name;
      entry["title"] = driver.title;
      entry["extensions"] = driver.extensions;
      entry["description"] = driver.description;
      entry["reads"] = [&] {
        py::list reads;
        for (const auto& [name, what] :
             {std::pair{"mesh", &formats::Reads::mesh}, std::pair{"raster", &formats::Reads::raster},
              std::pair{"footprints", &formats::Reads::footprints}, std::pair{"models", &formats::Reads::models},
              std::pair{"results", &formats::Reads::results}})
          if (driver.reads.*what) reads.append(name);
        return reads;
      }();
      entry["writes"] = driver.writes.has_value();
      all.append(entry);
    }
    return all;
  });
}

}  // namespace mansard::python
