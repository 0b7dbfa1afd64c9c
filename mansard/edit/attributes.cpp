#include "mansard/edit/attributes.hpp"

namespace mansard::edit {

auto attributes() -> std::vector<formats::Attribute> {
  return {{"ms_edited",
           "edit",
           {"Building", "BuildingPart"},
           "boolean",
           "",
           "true where the plan is not that of the run any more; absent elsewhere."}};
}

}  // namespace mansard::edit
