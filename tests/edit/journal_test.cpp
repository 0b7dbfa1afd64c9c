#include <gmock/gmock.h>

#include "edit/plans.hpp"

namespace mansard::edit {
namespace {

using testing::HasSubstr;

auto city() -> model::City { return test::city_of({test::house(0), test::house(10), test::house(20)}); }

/// A change to one or two buildings, with numbers that no decimal has, or an undo, or a redo; its line.
auto something(base::Random& random, History& history) -> std::string {
  switch (random.index(5)) {
    case 0:
      if (history.undo()) return std::string(undo_line);
      break;
    case 1:
      if (history.redo()) return std::string(redo_line);
      break;
    default: break;
  }
  Edit edit{"gutter to \"7\u00bd m\"\n", {}};
  const std::size_t count = 1 + random.index(2), first = random.index(3);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string building(1, static_cast<char>('a' + (first + i) % 3));
    Change change{building, history.revision(building), *history.parts(building)};
    if (change.parts.empty() || random.index(4) == 0) {
      base::Random shape(random.next());
      change.parts.push_back({"new-" + std::to_string(random.next()),
                              test::plan_of(test::star(shape, 7), {test::pitch, test::wall}, shape.uniform())});
    } else if (random.index(4) == 0) {
      change.parts.pop_back();
    } else {
      change.parts[0].plan.cap = random.uniform(1, 20) / 3;
    }
    edit.changes.push_back(std::move(change));
  }
  EXPECT_TRUE(history.apply(edit));
  return journal_line(edit);
}

TEST(Journal, gives_the_same_state_again_wherever_its_last_line_is_cut) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Random random(seed);
    History history(city());
    std::string journal;
    for (int i = 0; i < 12; ++i) journal += something(random, history) + "\n";
    const auto whole = replay(city(), journal);
    ASSERT_TRUE(whole) << base::to_string(whole.error());
    ASSERT_EQ(whole->history, history);
    EXPECT_EQ(whole->kept, journal.size());

    const auto before = history;
    const auto last = something(random, history);
    for (std::size_t cut = 0; cut <= last.size(); ++cut) {
      const auto torn = replay(city(), journal + last.substr(0, cut));
      ASSERT_TRUE(torn) << base::to_string(torn.error());
      ASSERT_EQ(torn->kept, journal.size());
      if (cut % 97 != 0) continue;
      ASSERT_EQ(torn->history, before) << cut;
    }
    const auto now = replay(city(), journal + last + "\n");
    ASSERT_TRUE(now);
    EXPECT_EQ(now->history, history);
  }
}

TEST(Journal, names_the_line_that_cannot_be_done_again) {
  History history(city());
  Edit edit{"cap", {{"a", 0, *history.parts("a")}}};
  edit.changes[0].parts[0].plan.cap = 7;
  const auto good = journal_line(edit) + "\n";
  const auto refused = [&](const std::string& line) {
    const auto result = replay(city(), good + line + "\n" + std::string(undo_line) + "\n");
    EXPECT_FALSE(result) << line;
    if (result) return std::string();
    EXPECT_EQ(result.error().code, "edit-journal");
    EXPECT_THAT(result.error().message, HasSubstr("line 2 "));
    return result.error().message;
  };
  EXPECT_THAT(refused("{\"what\":"), HasSubstr("not JSON"));
  EXPECT_THAT(refused(""), HasSubstr("not JSON"));
  EXPECT_THAT(refused(std::string(1'000'000, '[')), HasSubstr("nested too deep"));
  EXPECT_THAT(refused("{}"), HasSubstr("\"what\""));
  EXPECT_THAT(refused(R"({"what":"x","changes":[],"by":"me"})"), HasSubstr("\"by\""));
  EXPECT_THAT(refused(R"({"what":"x","changes":[{"building":"a","revision":-1,"parts":[]}]})"), HasSubstr("revision"));
  EXPECT_THAT(
      refused(R"({"what":"x","changes":[{"building":"a","revision":1,"parts":[{"id":"p","plan":{"base":0}}]}]})"),
      HasSubstr("cap"));
  EXPECT_THAT(refused(journal_line(edit)), HasSubstr("changed elsewhere"));  // of revision 0, again
  EXPECT_THAT(refused(std::string(redo_line)), HasSubstr("done again"));
}

}  // namespace
}  // namespace mansard::edit
