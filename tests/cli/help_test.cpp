// What the program shows of its options: help of a verb on one screen, the modules that it reads and no other, and what
// it says when an option is another verb's.
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/command.hpp"

namespace mansard::cli {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

auto lines_of(const std::string& text) -> std::vector<std::string> {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Columns on a terminal, which are code points here, of the first `bytes` of a line.
auto columns(const std::string& line, std::size_t bytes = std::string::npos) -> std::size_t {
  std::size_t n = 0;
  for (std::size_t i = 0; i < std::min(bytes, line.size()); ++i)
    n += (static_cast<unsigned char>(line[i]) & 0xC0) != 0x80 ? 1 : 0;
  return n;
}

/// The lines below a heading, up to the next empty one.
auto section(const std::string& text, const std::string& heading) -> std::vector<std::string> {
  std::vector<std::string> found;
  bool inside = false;
  for (const auto& line : lines_of(text)) {
    if (inside && line.empty()) break;
    if (inside) found.push_back(line);
    inside = inside || line == heading + ":";
  }
  return found;
}

class Help : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    known_ = nlohmann::json::parse(run("options --all --json").out);
    ASSERT_GT(known_["verbs"].size(), 10U);
  }
  /// Option names by module, as they are typed.
  [[nodiscard]] auto by_module() const -> std::map<std::string, std::vector<std::string>> {
    std::map<std::string, std::vector<std::string>> all;
    for (const auto& option : known_["options"]) {
      const std::string module = option["module"];
      auto name = "--" + module + "-" + option["name"].get<std::string>();
      std::ranges::replace(name, '_', '-');
      all[module].push_back(name);
    }
    return all;
  }

  nlohmann::json known_;
};

TEST_F(Help, of_the_program_lists_every_verb_by_task_on_one_screen) {
  const auto help = run("--help");
  EXPECT_EQ(help.exit, 0);
  EXPECT_EQ(run("-h").out, help.out);
  const auto lines = lines_of(help.out);
  EXPECT_LE(lines.size(), 40U);
  for (const auto& verb : known_["verbs"]) {
    const auto listed = section(help.out, verb["task"].get<std::string>());
    const std::string start = "  " + verb["verb"].get<std::string>() + " ";
    EXPECT_EQ(std::ranges::count_if(listed, [&](const auto& line) { return line.starts_with(start); }), 1) << start;
  }
  EXPECT_THAT(help.out, Not(HasSubstr("OPTIONS")));
}

TEST_F(Help, of_every_verb_fits_one_screen) {
  for (const auto& verb : known_["verbs"]) {
    const std::string name = verb["verb"];
    const auto help = run(name + " --help");
    EXPECT_EQ(help.exit, 0) << name;
    EXPECT_EQ(help.err, "");
    EXPECT_THAT(help.out, StartsWith("Usage: mansard " + name)) << name;
    const auto lines = lines_of(help.out);
    EXPECT_LE(lines.size(), 40U) << help.out;
    for (const auto& line : lines) EXPECT_LE(columns(line), 100U) << name << ": " << line;
    EXPECT_FALSE(section(help.out, "Examples").empty()) << name;
    const auto options = section(help.out, "Options");
    const auto shown = std::ranges::count_if(options, [](const auto& line) { return line.starts_with("  -"); });
    EXPECT_LE(shown, 15) << name;
    if (verb["modules"].empty()) {
      EXPECT_THAT(help.out, Not(HasSubstr("--help-all"))) << name;
    } else {
      EXPECT_GE(shown, name == "info" ? 7 : 8) << name;
    }
  }
}

TEST_F(Help, fits_a_narrow_terminal) {
  ::setenv("COLUMNS", "80", 1);
  for (const auto& verb : known_["verbs"])
    for (const auto* help : {" --help", " --help-all"})
      for (const auto& line : lines_of(run(verb["verb"].get<std::string>() + help).out))
        if (line.find(" mansard ") == std::string::npos) {  // commands are not broken
          EXPECT_LE(columns(line), 80U) << line;
        }
  for (const auto* words : {"", "--help"})
    for (const auto& line : lines_of(run(words).out)) EXPECT_LE(columns(line), 80U) << line;
  ::unsetenv("COLUMNS");
}

TEST_F(Help, names_units_and_defaults) {
  const auto help = run("reconstruct --help").out;
  EXPECT_THAT(help, HasSubstr("default 10]"));
  EXPECT_THAT(help, HasSubstr("[m²;"));
  EXPECT_THAT(help, HasSubstr("cityjson,obj,glb,geopackage,plans]"));
  const auto full = run("reconstruct --help-all").out;
  EXPECT_THAT(full, HasSubstr("0.01 to 10; default 0.2]"));
  EXPECT_THAT(full, HasSubstr("sweep or plain; default plain]"));
}

TEST_F(Help, names_every_format_that_the_verb_reads) {
  for (const auto* verb : {"reconstruct", "segment", "label", "evaluate", "info", "explore"}) {
    const auto help = run(std::string(verb) + " --help").out;
    for (const auto* format : {"OBJ", "PLY", "OFF", "glTF", "GLB", "3D Tiles", "GeoTIFF", ".zip"})
      EXPECT_THAT(help, HasSubstr(format)) << verb;
  }
  for (const auto* verb : {"label", "evaluate", "convert", "info"})
    for (const auto* format : {"CityJSONSeq", "GeoPackage", "plans"})
      EXPECT_THAT(run(std::string(verb) + " --help").out, HasSubstr(format)) << verb;
}

TEST_F(Help, all_of_a_verb_shows_the_modules_that_it_reads_and_no_other) {
  const auto modules = by_module();
  for (const auto& verb : known_["verbs"]) {
    const std::string name = verb["verb"];
    const auto help = run(name + " --help-all");
    EXPECT_EQ(help.exit, 0) << name;
    const auto declared = verb["modules"].get<std::vector<std::string>>();
    std::vector<std::string> headings;
    for (const auto& line : lines_of(help.out)) {
      EXPECT_LE(columns(line), 100U) << name << ": " << line;
      const std::string start = "Options of the module ";
      if (line.starts_with(start)) headings.push_back(line.substr(start.size(), line.size() - start.size() - 1));
    }
    std::vector<std::string> with_options;
    for (const auto& module : declared)
      if (modules.contains(module)) with_options.push_back(module);
    EXPECT_EQ(headings, with_options) << name;
    std::size_t advanced = 0;
    for (const auto& option : verb["options"]) {
      const std::string module = option["module"];
      if (!module.empty()) {
        EXPECT_THAT(declared, Contains(module)) << name;
      }
      advanced += option["advanced"] == true ? 1 : 0;
      const std::string first = option["names"][0];
      if (first == "--help-all" && declared.empty()) continue;
      const auto shown = [&](const char* behind) { return help.out.find(first + behind) != std::string::npos; };
      EXPECT_NE(shown(" ") || shown(",") || shown("\n"), option["advanced"] == true) << name << " " << first;
    }
    if (advanced > 0) {
      EXPECT_THAT(help.out, HasSubstr("\n" + std::to_string(advanced) + " advanced options")) << name;
    }
  }
  EXPECT_LE(lines_of(run("convert --help-all").out).size(), lines_of(run("reconstruct --help-all").out).size() / 2);
  EXPECT_THAT(run("convert --help-all").out, Not(HasSubstr("gamma")));
}

TEST_F(Help, an_option_of_a_module_that_the_verb_does_not_read_is_refused_with_the_verbs_that_do) {
  const std::set<std::string> verbs_without_output{"doctor", "info", "new"};
  std::map<std::string, std::set<std::string>> readers;
  for (const auto& verb : known_["verbs"])
    for (const auto& module : verb["modules"]) readers[module].insert(verb["verb"]);
  for (const auto& verb : known_["verbs"])
    for (const auto& [module, options] : by_module()) {
      const std::string name = verb["verb"];
      if (readers[module].contains(name) || verb["modules"].empty()) continue;
      const auto outcome =
          run(name + (verbs_without_output.contains(name) ? " a b " : " a b -o c ") + options.front() + " 1");
      expect_refusal(outcome, 2, "option-verb", "of the module " + module + ";");
      EXPECT_THAT(outcome.err, HasSubstr("] " + options.front() + ": 'mansard " + name + "'"));
      for (const auto& reader : readers[module]) EXPECT_THAT(outcome.err, HasSubstr(reader)) << outcome.err;
    }
  expect_refusal(run("convert a -o b --gamma 5"), 2, "option-verb", "reconstruct, segment and explore");
  expect_refusal(run("segment a b -o c --picture"), 2, "option-verb", "reconstruct, extrude and simulate");
  expect_refusal(run("info a --gama 5"), 4, "option-unknown", "see 'mansard info --help-all'");
}

TEST_F(Help, what_a_verb_reads_changes_what_it_makes) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--formats glb").exit, 0);
  const auto convert = [&](const std::string& more) {
    EXPECT_EQ(run("convert -q " + at("out/model.glb") + " --overwrite -o " + at("c.glb") + " " + more).exit, 0) << more;
    return read(at("c.glb"));
  };
  const auto plain = convert("");
  for (const auto* more : {"--extrude-overhang 0.5", "--label-wall-angle 1.5", "--write-compress"})
    EXPECT_NE(convert(more), plain) << more;
}

TEST_F(Help, a_configuration_file_may_set_options_of_modules_that_the_verb_does_not_read) {
  ASSERT_EQ(reconstruct(at("house.obj"), at("house.geojson"), "--formats glb").exit, 0);
  const auto file = put("all.toml", "[sweep]\ngamma = 7\n[write]\ncompress = true\n");
  const auto converted = run("convert -q " + at("out/model.glb") + " -o " + at("c.glb") + " --config " + file);
  EXPECT_EQ(converted.exit, 0) << converted.err;
  const auto wrong = put("wrong.toml", "[sweep]\ngama = 7\n");
  EXPECT_EQ(run("convert -q " + at("out/model.glb") + " -o " + at("d.glb") + " --config " + wrong).exit, 4);
}

TEST_F(Help, a_failure_of_several_causes_names_them_all_and_ends_with_the_code_of_the_first) {
  const auto inputs = "-q " + at("house.obj") + " " + at("house.geojson") + " -o " + at("out");
  const auto values = run("reconstruct " + inputs + " --slice-interval -1 --profile-quality best");
  EXPECT_EQ(values.exit, 4);
  EXPECT_THAT(lines_of(values.err),
              testing::ElementsAre(HasSubstr("--slice-interval"), HasSubstr("--profile-quality")));
  const auto config = put("c.toml", "[segment]\nalfa = 3\n[sweep]\ngama = 5\n");
  const auto keys = run("reconstruct " + inputs + " --config " + config + " --gamma -1");
  EXPECT_EQ(keys.exit, 4);
  EXPECT_THAT(lines_of(keys.err), testing::ElementsAre(HasSubstr("'segment.alpha'"), HasSubstr("'sweep.gamma'"),
                                                       HasSubstr("--sweep-gamma")));
  // A failure that the catalogue lists with exit code 2 comes first here, one with 4 second.
  const auto names = run("convert a -o b --gamma 5 --write-compres");
  EXPECT_EQ(names.exit, 2);
  EXPECT_THAT(lines_of(names.err),
              testing::ElementsAre(HasSubstr("error[option-verb]"), HasSubstr("did you mean '--write-compress'?")));
}

TEST_F(Help, options_are_listed_in_columns) {
  const auto lines = lines_of(run("options").out);
  const auto column = columns(lines.front(), lines.front().find("meaning"));
  EXPECT_THAT(lines.front(), AllOf(HasSubstr("option"), HasSubstr("default"), HasSubstr("unit"), HasSubstr("range")));
  std::size_t rows = 0;
  for (const auto& line : lines) {
    if (line.empty()) break;
    if (line.starts_with("[")) continue;
    ++rows;
    std::size_t at = 0;
    while (columns(line, at) < column) ++at;
    EXPECT_EQ(line.substr(at - 2, 2), "  ") << line;
    EXPECT_NE(line.at(at), ' ') << line;
  }
  EXPECT_GT(rows, 50U);
}

TEST_F(Help, options_have_plain_words_in_json) {
  const auto listed = nlohmann::json::parse(run("options --json").out)["options"];
  std::set<std::string> kinds;
  for (const auto& option : listed) {
    kinds.insert(option["kind"]);
    for (const auto* word :
         {"module", "name", "unit", "minimum", "maximum", "default", "meaning", "advanced", "source"})
      EXPECT_TRUE(option.contains(word)) << option;
    EXPECT_EQ(option["advanced"], false) << option;
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"boolean", "choice", "integer", "number", "string"}));
  EXPECT_GE(known_["options"].size(), listed.size());
}

TEST_F(Help, advanced_options_are_accepted_but_listed_by_options_all_only) {
  std::vector<nlohmann::json> advanced;
  for (const auto& option : known_["options"])
    if (option["advanced"] == true) advanced.push_back(option);
  if (advanced.empty()) GTEST_SKIP() << "no option is advanced";
  const auto all = run("options --all").out, usual = run("options").out, manual = run("manual").out;
  EXPECT_THAT(usual, HasSubstr(std::to_string(advanced.size()) + " advanced options are not shown"));
  EXPECT_GT(lines_of(all).size(), lines_of(usual).size() + advanced.size());
  for (const auto& option : advanced) EXPECT_FALSE(option["source"].get<std::string>().empty()) << option;
  const auto& one = advanced.front();
  const std::string key = one["module"].get<std::string>() + "-" + one["name"].get<std::string>();
  auto typed = "--" + key;
  std::ranges::replace(typed, '_', '-');
  EXPECT_THAT(run("completion fish").out, Not(HasSubstr(typed.substr(2) + " ")));
  // One that is accepted leads to the next complaint: that there is no such mesh.
  for (const auto& verb : known_["verbs"])
    if (verb["verb"] == "reconstruct" && std::ranges::count(verb["modules"], one["module"]) > 0) {
      const auto outcome = run("reconstruct -q " + at("none.obj") + " " + at("house.geojson") + " -o " + at("out") +
                               " " + typed + " " + one["default"].get<std::string>());
      expect_refusal(outcome, 3, "file-missing");
    }
}

}  // namespace
}  // namespace mansard::cli
