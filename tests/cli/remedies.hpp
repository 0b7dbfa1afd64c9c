// What messages say to do is done here, as a user would: a command fails or warns and names what to do, and with that
// it works.
#pragma once

#include <regex>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace mansard::cli {

/// Commands that fail or warn and name what to do, and with that work.
class RemedyTest : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    put("two.geojson", with_ids(R"({"id":"a","other":"p"})", R"({"id":"b","other":"q"})"));
    put("table.csv", "key,colour\np,red\nq,blue\n");
  }

  static auto with_ids(const std::string& first, const std::string& second) -> std::string {
    const auto feature = [](const std::string& properties, const std::string& ring) {
      return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":)" + polygon(ring) + "}";
    };
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}},)"
           R"("features":[)" +
           feature(first, square) + "," + feature(second, "[20,0],[30,0],[30,8],[20,8],[20,0]") + "]}";
  }

  /// In commands, words with an @ are files.
  auto filled(std::string arguments) const -> std::string {
    const std::pair<const char*, std::string> places[] = {
        {"@MESH", at("house.obj")},  {"@PRINTS", at("house.geojson")}, {"@TWO", at("two.geojson")},
        {"@TABLE", at("table.csv")}, {"@MODEL", at("m.city.json")},    {"@OUT", at("out")},
        {"@HERE/", at("")}};
    for (const auto& [word, place] : places) arguments = std::regex_replace(arguments, std::regex(word), place);
    return arguments;
  }

  static auto zeros(int count) -> std::string {
    std::string out;
    for (int i = 0; i < count; ++i) out += "0 ";
    return out + "\n";
  }
  /// A terrain of zeros, 240 m wide, that begins at (`at`, `at`).
  static auto grid(const std::string& at) -> std::string {
    return "ncols 40\nnrows 40\nxllcorner " + at + "\nyllcorner " + at + "\ncellsize 6\n" + zeros(1600);
  }

  struct Case {
    std::string command;  ///< says `code`, and `words`
    std::string code, words;
    std::string instead;  ///< a whole command, what is added where it begins with "-", or `said`: works, and does not
                          ///< say `words`
  };
  static constexpr const char* said = "";  ///< the command that the message names
  void try_all(const std::vector<Case>& cases) const {
    ASSERT_EQ(run(filled("extrude -q @PRINTS --default-height 6 -o @MODEL")).exit, 0);
    for (const auto& [command, code, words, instead] : cases) {
      SCOPED_TRACE(command);
      const auto without = run(filled(command));
      EXPECT_THAT(without.err, testing::HasSubstr("[" + code + "]"));
      EXPECT_THAT(without.err, testing::HasSubstr(words));
      fs::remove_all(at("out"));
      auto told = filled(instead.starts_with("-") ? command + " " + instead : instead);
      std::smatch named;
      if (instead == said && std::regex_search(without.err, named, std::regex("run: mansard (.*)"))) told = named[1];
      ASSERT_NE(told, "");
      const auto remedied = run(told);
      EXPECT_TRUE(remedied.exit == 0 || remedied.exit == 1) << told << ": " << remedied.exit << " " << remedied.err;
      EXPECT_THAT(remedied.err, testing::Not(testing::HasSubstr(words)));
      fs::remove_all(at("out"));
    }
  }
};

}  // namespace mansard::cli
