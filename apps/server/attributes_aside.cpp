#include "apps/server/attributes_aside.hpp"

#include <algorithm>
#include <set>

#include "mansard/base/pack.hpp"

namespace mansard::server {
namespace {

/// The list of names, and the values in their order.
struct Record {
  std::uint32_t names = 0;
  std::vector<model::Value> values;
};

auto values_of(model::Attributes& attributes) -> std::vector<model::Value> {
  std::vector<model::Value> values;
  values.reserve(attributes.size());
  for (auto& one : attributes) values.push_back(std::move(one.second));
  attributes = {};
  return values;
}

}  // namespace

auto AttributesAside::open() -> base::Result<std::unique_ptr<AttributesAside>> {
  auto spool = base::Spool::open();
  if (!spool) return spool.failure();
  auto out = std::make_unique<AttributesAside>();
  out->spool_ = std::move(*spool);
  return out;
}

auto AttributesAside::Lists::number_of(const model::Attributes& attributes) -> std::uint32_t {
  const auto is_of = [&](const Names& names) {
    return std::ranges::equal(names, attributes, {}, {}, &model::Attributes::value_type::first);
  };
  if (!all.empty() && is_of(all.back())) return static_cast<std::uint32_t>(all.size() - 1);
  Names names;
  for (const auto& one : attributes) names.push_back(one.first);
  const auto [at, is_new] = numbers.emplace(names, static_cast<std::uint32_t>(all.size()));
  if (is_new) all.push_back(std::move(names));
  return at->second;
}

void AttributesAside::add(model::Building& building) {
  Record own{of_buildings_.number_of(building.attributes), {}};
  own.values = values_of(building.attributes);
  std::vector<Record> parts;
  for (auto& part : building.parts) {
    parts.push_back({of_parts_.number_of(part.attributes), {}});
    parts.back().values = values_of(part.attributes);
  }
  const auto bytes = base::packed(std::pair(std::move(own), std::move(parts)));
  places_.push_back({spool_->size(), static_cast<std::uint32_t>(bytes.size())});
  spool_->append(bytes);
}

auto AttributesAside::restore(std::size_t number, model::Building& building) const -> base::Result<void> {
  std::string bytes;
  {
    const std::scoped_lock lock(mutex_);
    auto read = spool_->read(places_[number].offset, places_[number].bytes);
    if (!read) return read.failure();
    bytes = std::move(*read);
  }
  std::pair<Record, std::vector<Record>> all;
  base::Unpacker from(bytes);
  if (!from.take(all) || !from.done() || all.second.size() != building.parts.size())
    return base::error("file-write", "what was put aside in the folder for temporary files (TMPDIR) was changed there");
  const auto put = [](Record& record, const std::vector<Names>& names, model::Attributes& to) {
    to.clear();
    to.reserve(record.values.size());
    for (std::size_t i = 0; i < record.values.size(); ++i)
      to.emplace_back(names[record.names][i], std::move(record.values[i]));
  };
  put(all.first, of_buildings_.all, building.attributes);
  for (std::size_t p = 0; p < building.parts.size(); ++p)
    put(all.second[p], of_parts_.all, building.parts[p].attributes);
  return {};
}

auto AttributesAside::names() const -> std::vector<std::string> {
  std::vector<std::string> order;
  std::set<std::string> seen;
  for (const auto* lists : {&of_buildings_, &of_parts_})
    for (const auto& names : lists->all)
      for (const auto& name : names)
        if (seen.insert(name).second) order.push_back(name);
  return order;
}

}  // namespace mansard::server
