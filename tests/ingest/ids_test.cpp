// Names of parts, beside ids of any kind.
#include <map>
#include <random>
#include <set>

#include "ingest/workshop.hpp"
#include "mansard/formats/vector/attributes.hpp"

namespace mansard::ingest::test {
namespace {

using Ids = std::vector<std::string>;
using formats::part_prefixes_of;

TEST(PartNames, are_the_id_and_a_number_where_nothing_else_has_them) {
  EXPECT_TRUE(part_prefixes_of({"a", "b-1", "c", "a1", "a-b"}).empty());
  EXPECT_EQ(part_prefixes_of({"a", "a-1"}), (std::map<std::string, std::string>{{"a", "a--"}}));
  EXPECT_EQ(part_prefixes_of({"12", "12-1", "12--3"}), (std::map<std::string, std::string>{{"12", "12---"}}));
}

TEST(PartNames, are_no_ids_and_no_names_of_other_parts) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    std::set<std::string> some;
    for (int i = 0; i < 30; ++i) {
      std::string id;
      for (auto left = 1 + random() % 6; left > 0; --left) id += "a-12"[random() % 4];
      some.insert(id);
    }
    const Ids ids(some.begin(), some.end());
    const auto prefixes = part_prefixes_of(ids);
    std::set<std::string> names(ids.begin(), ids.end());
    for (const auto& id : ids)
      for (std::size_t n : {1, 2, 11, 12, 21}) {
        model::Footprint footprint;
        footprint.id = id;
        if (const auto found = prefixes.find(id); found != prefixes.end()) footprint.part_prefix = found->second;
        EXPECT_TRUE(names.insert(footprint.part_id(n)).second) << footprint.part_id(n) << " of " << id;
      }
  }
}

TEST(Ids, that_were_given_are_not_changed_by_names_for_those_without) {
  std::vector<formats::RawFeature> features(3);
  for (std::size_t i = 0; i < 3; ++i) features[i].number = static_cast<std::int64_t>(i);
  features[1].attributes = {{"id", std::string("x")}};
  features[2].attributes = {{"id", std::string("feature-0")}};
  std::vector<base::Diagnostic> warnings;
  const auto ids = formats::ids_of(features, "id", "f", warnings);
  ASSERT_TRUE(ids);
  EXPECT_EQ(*ids, (Ids{"feature-0~2", "x", "feature-0"}));
}

TEST(Ids, that_become_the_same_are_made_different) {
  std::vector<formats::RawFeature> features(3);
  features[0].attributes = {{"id", std::string("a\xE4")}};
  features[1].attributes = {{"id", std::string("a\xF6")}};
  features[2].attributes = {{"id", std::string("a\n")}};
  std::vector<base::Diagnostic> warnings;
  const auto ids = formats::ids_of(features, "id", "f", warnings);
  ASSERT_TRUE(ids);
  EXPECT_EQ(*ids, (Ids{"a\xEF\xBF\xBD", "a\xEF\xBF\xBD~2", "a\xEF\xBF\xBD~3"}));
  ASSERT_EQ(warnings.size(), 1);
  EXPECT_EQ(warnings[0].code, "ingest-id-characters");
}

}  // namespace
}  // namespace mansard::ingest::test
