// The addresses of a building of CityJSON, as attributes.
#pragma once

#include <string>

#include "mansard/formats/cityjson/cityjson_document.hpp"

namespace mansard::formats::detail {

/// add(name, value) for what an address says in words and numbers: "address_Locality", of the second one
/// "address2_Locality". Its place, which is a geometry, is left out.
template <class Add>
void each_of_address(const Json& object, Add add) {
  const auto found = object.is_object() ? object.find("address") : object.end();
  if (found == object.end()) return;
  std::size_t number = 0;
  const auto take = [&](const Json& one) {
    ++number;
    if (!one.is_object()) return;
    for (const auto& [name, value] : one.items())
      if (value.is_string() || value.is_number() || value.is_boolean())
        add("address" + (number > 1 ? std::to_string(number) : std::string()) + "_" + name, value);
  };
  if (found->is_array())
    for (const auto& one : *found) take(one);
  else take(*found);  // CityJSON 1.0 has one
}

}  // namespace mansard::formats::detail
