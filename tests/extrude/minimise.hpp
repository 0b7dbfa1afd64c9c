// Plans as JSON, and small plans out of large ones: whatever a failure does not need is dropped.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "mansard/model/plan.hpp"

namespace plans {

/// The `plan` object of docs/plan.schema.json.
inline auto to_json(const mansard::model::Plan& plan) -> std::string {
  using nlohmann::ordered_json;
  const auto ring = [](const mansard::model::PlanRing& r) {
    ordered_json points = ordered_json::array();
    for (const auto& p : r.points) points.push_back({p.x, p.y});
    return ordered_json{{"points", points}, {"profile_of_edge", r.profile_of_edge}};
  };
  ordered_json out{{"base", plan.base}, {"cap", plan.cap}, {"outer", ring(plan.outer)}};
  out["holes"] = ordered_json::array();
  for (const auto& hole : plan.holes) out["holes"].push_back(ring(hole));
  out["profiles"] = ordered_json::array();
  for (const auto& profile : plan.profiles) {
    ordered_json knots = ordered_json::array();
    for (const auto& k : profile) knots.push_back({k.inward, k.height});
    out["profiles"].push_back(knots);
  }
  return out.dump();
}

/// Throws nlohmann::json::exception.
inline auto plan_from_json(const std::string& text) -> mansard::model::Plan {
  const auto json = nlohmann::json::parse(text);
  const auto ring = [](const nlohmann::json& r) {
    mansard::model::PlanRing out;
    for (const auto& p : r.at("points")) out.points.push_back({p.at(0).get<double>(), p.at(1).get<double>()});
    out.profile_of_edge = r.at("profile_of_edge").get<std::vector<std::uint32_t>>();
    return out;
  };
  mansard::model::Plan plan;
  plan.base = json.at("base").get<double>();
  plan.cap = json.at("cap").get<double>();
  plan.outer = ring(json.at("outer"));
  for (const auto& hole : json.at("holes")) plan.holes.push_back(ring(hole));
  for (const auto& profile : json.at("profiles")) {
    plan.profiles.emplace_back();
    for (const auto& k : profile) plan.profiles.back().push_back({k.at(0).get<double>(), k.at(1).get<double>()});
  }
  return plan;
}

/// Makes a failing plan smaller for as long as it fails. Gives the same plan for the same input.
class Minimiser {
 public:
  using Plan = mansard::model::Plan;
  using Ring = mansard::model::PlanRing;
  /// Whether the plan still fails, in the way that is looked for. Must answer for any plan, sensible or not.
  using Fails = std::function<bool(const Plan&)>;

  Minimiser(Fails fails, std::size_t most_tries) : fails_(std::move(fails)), most_tries_(most_tries) {}

  auto run(Plan plan) -> Plan {
    best_ = std::move(plan);
    for (bool shrunk = true; shrunk && tries_ < most_tries_;) {
      const Plan before = best_;
      drop_holes();
      for (std::size_t r = 0; r <= best_.holes.size(); ++r) drop_corners(r);
      unify_profiles();
      drop_profiles();
      drop_knots();
      round_numbers();
      shrunk = !(best_ == before);
    }
    return best_;
  }
  [[nodiscard]] auto tries() const -> std::size_t { return tries_; }

 private:
  static auto ring_of(Plan& plan, std::size_t r) -> Ring& { return r == 0 ? plan.outer : plan.holes[r - 1]; }

  auto keep_if_failing(const Plan& candidate) -> bool {
    if (tries_ >= most_tries_ || candidate == best_) return false;
    ++tries_;
    if (!fails_(candidate)) return false;
    best_ = candidate;
    return true;
  }

  void drop_holes() {
    for (std::size_t h = best_.holes.size(); h-- > 0;) {
      Plan less = best_;
      less.holes.erase(less.holes.begin() + static_cast<std::ptrdiff_t>(h));
      keep_if_failing(less);
    }
  }

  /// Ever shorter stretches of corners (A. Zeller, R. Hildebrandt, Simplifying and Isolating Failure-Inducing Input,
  /// IEEE TSE 28(2), 2002).
  void drop_corners(std::size_t r) {
    for (std::size_t stretch = ring_of(best_, r).points.size() / 2; stretch > 0; stretch /= 2)
      for (std::size_t at = 0; at < ring_of(best_, r).points.size();) {
        Plan less = best_;
        Ring& ring = ring_of(less, r);
        const std::size_t count = std::min(stretch, ring.points.size() - at);
        const auto from = static_cast<std::ptrdiff_t>(at), to = static_cast<std::ptrdiff_t>(at + count);
        ring.points.erase(ring.points.begin() + from, ring.points.begin() + to);
        ring.profile_of_edge.erase(ring.profile_of_edge.begin() + from, ring.profile_of_edge.begin() + to);
        if (ring.points.size() < 3 || !keep_if_failing(less)) at += count;
      }
  }

  void unify_profiles() {
    const auto set_all = [](Plan& plan, std::uint32_t k) {
      plan.outer.profile_of_edge.assign(plan.outer.points.size(), k);
      for (Ring& hole : plan.holes) hole.profile_of_edge.assign(hole.points.size(), k);
    };
    for (std::uint32_t k = 0; k < best_.profiles.size(); ++k) {
      Plan same = best_;
      set_all(same, k);
      if (keep_if_failing(same)) return;
    }
    for (std::uint32_t k = 0; k < best_.profiles.size(); ++k)  // one profile after the other goes
      for (std::uint32_t with = 0; with < k; ++with) {
        Plan fewer = best_;
        for (std::size_t r = 0; r <= fewer.holes.size(); ++r)
          for (std::uint32_t& of : ring_of(fewer, r).profile_of_edge)
            if (of == k) of = with;
        if (keep_if_failing(fewer)) break;
      }
  }

  void drop_profiles() {
    Plan fewer = best_;
    std::vector<std::uint32_t> renamed(fewer.profiles.size(), UINT32_MAX);
    std::vector<mansard::model::Profile> used;
    for (std::size_t r = 0; r <= fewer.holes.size(); ++r)
      for (std::uint32_t& of : ring_of(fewer, r).profile_of_edge) {
        if (of >= renamed.size()) return;
        if (renamed[of] == UINT32_MAX) {
          renamed[of] = static_cast<std::uint32_t>(used.size());
          used.push_back(fewer.profiles[of]);
        }
        of = renamed[of];
      }
    fewer.profiles = std::move(used);
    keep_if_failing(fewer);
  }

  void drop_knots() {
    for (std::size_t p = 0; p < best_.profiles.size(); ++p)
      for (std::size_t k = best_.profiles[p].size(); k-- > 1 && best_.profiles[p].size() > 2;) {
        Plan less = best_;
        less.profiles[p].erase(less.profiles[p].begin() + static_cast<std::ptrdiff_t>(k));
        keep_if_failing(less);
      }
  }

  /// First everything to as few digits as it can stand, then number by number.
  void round_numbers() {
    Plan at_home = best_;
    at_home.base = 0;
    const auto corner = mansard::geometry::bounds(best_.outer.points).least;
    for (std::size_t r = 0; r <= at_home.holes.size(); ++r)
      for (auto& p : ring_of(at_home, r).points) p = p - corner;
    keep_if_failing(at_home);
    const auto numbers = [](Plan& plan) {
      std::vector<double*> out{&plan.cap};
      for (std::size_t r = 0; r <= plan.holes.size(); ++r)
        for (auto& p : ring_of(plan, r).points) out.insert(out.end(), {&p.x, &p.y});
      for (auto& profile : plan.profiles)
        for (auto& k : profile) out.insert(out.end(), {&k.inward, &k.height});
      return out;
    };
    const auto rounded = [](double v, double unit) { return std::round(v * unit) / unit; };
    double coarsest = 1e9;
    for (const double unit : {1.0, 2.0, 4.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6}) {
      Plan round = best_;
      for (double* v : numbers(round)) *v = rounded(*v, unit);
      coarsest = unit;
      if (round == best_ || keep_if_failing(round)) break;
    }
    const std::size_t count = numbers(best_).size();
    for (std::size_t i = 0; i < count; ++i)
      for (const double unit : {1.0, 2.0, 4.0, 10.0, 100.0, 1e3, 1e4}) {
        if (unit >= coarsest) break;
        Plan round = best_;
        double& v = *numbers(round)[i];
        if (v == rounded(v, unit)) break;
        v = rounded(v, unit);
        if (keep_if_failing(round)) break;
      }
  }

  Fails fails_;
  std::size_t most_tries_, tries_ = 0;
  Plan best_;
};

[[nodiscard]] inline auto minimised(mansard::model::Plan plan, Minimiser::Fails fails, std::size_t most_tries = 4000)
    -> mansard::model::Plan {
  return Minimiser(std::move(fails), most_tries).run(std::move(plan));
}

/// The plan written into a folder when the environment has MANSARD_KEEP_FAILURES: where to, or nothing. The name is
/// that of the failure and a number that is the plan's own.
inline auto keep_failure(const mansard::model::Plan& plan, const std::filesystem::path& folder, std::string name)
    -> std::string {
  if (std::getenv("MANSARD_KEEP_FAILURES") == nullptr) return "";
  const std::string json = to_json(plan);
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : json) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  std::ostringstream path;
  path << name << '_' << std::hex << std::setw(8) << std::setfill('0') << (hash >> 32) << ".json";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / path.str()) << json << "\n";
  return (folder / path.str()).string();
}

}  // namespace plans
