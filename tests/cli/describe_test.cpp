// What the program says of itself: the manual page, the shells' completions, and the lists that the docs are made of.
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Describe : public Command {
 protected:
  auto shell(const std::string& command) const -> Outcome {
    const int status = std::system((command + " >" + at("stdout") + " 2>" + at("stderr") + " </dev/null").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(at("stdout")), read(at("stderr"))};
  }
  [[nodiscard]] auto has(const std::string& program) const -> bool { return shell("command -v " + program).exit == 0; }
  auto completion_for(const std::string& name) -> std::string {
    const auto script = run("completion " + name);
    EXPECT_EQ(script.exit, 0) << script.err;
    return put("completion." + name, script.out);
  }
  /// What bash offers for the last of these words, as a terminal's Tab does.
  auto bash_offers(const std::string& words) -> std::vector<std::string> {
    put("ask.bash", "source " + completion_for("bash") + "\ncd " + at("") + "\nCOMP_WORDS=(" + words +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_mansard\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const auto answer = shell("bash --norc " + at("ask.bash"));
    EXPECT_EQ(answer.exit, 0) << answer.err;
    std::vector<std::string> lines;
    std::istringstream in(answer.out);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
  /// Every long option of a verb, by its own help.
  auto options_in_help(const std::string& verb) -> std::set<std::string> {
    const auto help = run(verb + " --help-all");
    std::set<std::string> names;
    std::istringstream in(help.exit == 0 ? help.out : run(verb + " --help").out);
    for (std::string line; std::getline(in, line);) {
      const auto first = line.find_first_not_of(' ');
      if (first == std::string::npos || first == 0 || first > 8 || line[first] != '-') continue;
      std::istringstream words(line);
      for (std::string name; words >> name && name.starts_with("-");)
        if (name.starts_with("--")) names.insert(name.substr(0, name.find(',')));
    }
    return names;
  }
};

TEST_F(Describe, bash_completes_a_verb) {
  EXPECT_THAT(bash_offers("mansard rec"), testing::ElementsAre("reconstruct"));
}

TEST_F(Describe, bash_completes_an_option_of_the_verb_and_of_no_other) {
  EXPECT_THAT(bash_offers("mansard reconstruct --sweep-gam"), testing::ElementsAre("--sweep-gamma"));
  EXPECT_THAT(bash_offers("mansard simulate --sweep-gam"), testing::ElementsAre(""));
  EXPECT_THAT(bash_offers("mansard convert --sweep-gam"), testing::ElementsAre(""));
}

TEST_F(Describe, bash_completes_the_words_that_an_option_takes) {
  EXPECT_THAT(bash_offers("mansard reconstruct --preset ''"), testing::ElementsAre("paper", "chordatlas"));
  EXPECT_THAT(bash_offers("mansard simulate --preset obl"), testing::ElementsAre("oblique-aerial"));
  EXPECT_THAT(bash_offers("mansard simulate --block perim"), testing::ElementsAre("perimeter"));
  EXPECT_THAT(bash_offers("mansard explain solver-m"), testing::ElementsAre("solver-mps"));
}

TEST_F(Describe, bash_completes_files_for_arguments_and_folders_for_outputs) {
  fs::create_directories(folder_ / "house-made");
  EXPECT_THAT(bash_offers("mansard reconstruct hous"),
              testing::UnorderedElementsAre("house.obj", "house.geojson", "house-made"));
  EXPECT_THAT(bash_offers("mansard reconstruct house.obj house.geojson -o hous"), testing::ElementsAre("house-made"));
}

TEST_F(Describe, bash_offers_every_option_that_the_help_of_a_verb_names) {
  for (const auto* verb :
       {"reconstruct", "segment", "extrude", "simulate", "evaluate", "label", "explore", "options"}) {
    const auto offered = bash_offers(std::string("mansard ") + verb + " --");
    const auto named = options_in_help(verb);
    EXPECT_FALSE(named.empty()) << verb;
    for (const auto& name : named) EXPECT_THAT(offered, Contains(name)) << verb;
  }
}

TEST_F(Describe, zsh_and_fish_take_their_scripts) {
  for (const auto* name : {"zsh", "fish"}) {
    const auto script = completion_for(name);
    EXPECT_THAT(read(script), HasSubstr("sweep-gamma")) << name;
    EXPECT_LT(fs::file_size(script), 1'000'000U) << name << " repeats what options without a maximum of values take";
    if (!has(name)) continue;
    const auto checked = shell(std::string(name) + " -n " + script);
    EXPECT_EQ(checked.exit, 0) << checked.err;
  }
  if (!has("fish")) GTEST_SKIP() << "no fish on this machine";
  put("ask.fish", "source " + at("completion.fish") + "\ncomplete -C 'mansard reconstruct --sweep-gam'\n");
  const auto offered = shell("HOME=" + at("") + " fish --no-config " + at("ask.fish"));
  EXPECT_THAT(offered.out, testing::StartsWith("--sweep-gamma\t")) << offered.err;
}

TEST_F(Describe, a_shell_without_a_completion_is_refused_with_those_there_are) {
  const auto outcome = run("completion tcsh");
  expect_refusal(outcome, 2, "usage", "bash, zsh or fish");
}

TEST_F(Describe, the_manual_page_is_set_by_groff_without_a_warning) {
  const auto page = run("manual");
  ASSERT_EQ(page.exit, 0) << page.err;
  put("mansard.1", page.out);
  const auto set = shell("groff -man -ww -Tutf8 " + at("mansard.1"));
  EXPECT_EQ(set.exit, 0);
  EXPECT_EQ(set.err, "");
  EXPECT_GT(set.out.size(), 20'000U);
}

TEST_F(Describe, the_manual_page_has_every_verb_and_every_option) {
  const auto page = run("manual").out;
  const auto in_roff = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
  };
  const auto listed = nlohmann::json::parse(run("options --json").out);
  ASSERT_GT(listed["options"].size(), 50U);
  for (const auto& option : listed["options"]) {
    auto name = "--" + option["module"].get<std::string>() + "-" + option["name"].get<std::string>();
    std::ranges::replace(name, '_', '-');
    EXPECT_THAT(page, HasSubstr("\\fB" + in_roff(name) + "\\fR")) << name;
  }
  for (const auto* verb : {"reconstruct", "simulate", "explain", "completion", "manual"})
    EXPECT_THAT(page, HasSubstr(std::string("\n.SS ") + verb + "\n"));
  for (const auto& name : options_in_help("explore")) EXPECT_THAT(page, HasSubstr(in_roff(name))) << name;
}

TEST_F(Describe, explain_lists_every_code_as_json_with_what_to_do) {
  const auto all = nlohmann::json::parse(run("explain --json").out);
  std::set<std::string> codes;
  for (const auto& entry : all["codes"]) {
    EXPECT_TRUE(codes.insert(entry["code"]).second) << entry["code"];
    EXPECT_FALSE(entry["cause"].get<std::string>().empty()) << entry["code"];
    EXPECT_FALSE(entry["remedy"].get<std::string>().empty()) << entry["code"];
  }
  EXPECT_THAT(codes, Contains("pipeline-nothing"));
  EXPECT_EQ(all["exit_codes"].size(), 8U);
  std::istringstream lines(run("explain").out);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) ++count;
  EXPECT_EQ(count, codes.size());
}

/// Every attribute with our prefix in a CityJSON, as "object name type"; types as JSON has them.
auto attributes_in(const nlohmann::json& city) -> std::set<std::array<std::string, 3>> {
  std::set<std::array<std::string, 3>> found;
  const auto take = [&found](const std::string& of, const nlohmann::json& members) {
    for (const auto& [name, value] : members.items())
      if (name.starts_with("ms_") || name.starts_with("+ms_")) found.insert({of, name, value.type_name()});
  };
  for (const auto& object : city["CityObjects"]) {
    take(object["type"], object.value("attributes", nlohmann::json::object()));
    for (const auto& geometry : object.value("geometry", nlohmann::json::array()))
      if (geometry.contains("semantics"))
        for (const auto& surface : geometry["semantics"]["surfaces"]) take(surface["type"], surface);
  }
  return found;
}

TEST_F(Describe, every_attribute_in_the_models_is_in_the_list_with_its_object_and_type) {
  put("plots.geojson", geojson(polygon(square)));
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson")).exit, 0);
  ASSERT_LE(run("extrude -q " + at("plots.geojson") + " -o " + at("blocks.city.json")).exit, 1);
  ASSERT_EQ(run("simulate -q --block detached --simulate-size 30 -o " + at("made")).exit, 0);
  std::set<std::array<std::string, 3>> found;
  for (const auto* file : {"out/model.city.json", "blocks.city.json", "made/truth.city.json"})
    found.merge(attributes_in(nlohmann::json::parse(read(at(file)))));
  EXPECT_GT(found.size(), 20U);

  std::set<std::array<std::string, 3>> listed;
  const auto list = nlohmann::json::parse(run("options --attributes --json").out);
  for (const auto& attribute : list["attributes"])
    for (const auto& of : attribute["of"]) {
      auto type = attribute["type"].get<std::string>();
      if (type.ends_with("?")) listed.insert({of, attribute["name"], "null"}), type.pop_back();
      listed.insert({of, attribute["name"], type});
    }
  for (const auto& attribute : found) EXPECT_THAT(listed, Contains(attribute));
  // And what one simple house has is there: nothing is listed that is never written.
  for (const auto* name :
       {"ms_h_ground", "ms_h_roof_50p", "ms_h_ridge", "ms_volume_lod22", "ms_rmse_lod22", "ms_opt_gap", "ms_fallback",
        "ms_slope", "ms_party_wall", "+ms_plan", "+ms_footprint", "ms_role", "ms_roof_shape"})
    EXPECT_TRUE(std::ranges::any_of(found, [&](const auto& entry) { return entry[1] == name; })) << name;
}

}  // namespace
}  // namespace mansard::cli
