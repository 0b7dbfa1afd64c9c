#include <cstdio>

#include "mansard/extrude/extrude.hpp"
#include "mansard/solid/solid.hpp"

int main() {
  mansard::model::Plan plan;
  plan.outer = {{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {0, 1, 0, 1}};  // corners, and the profile of each edge
  plan.profiles = {{{0, 0}, {0, 6}, {4, 10}}, {{0, 0}, {0, 10}}};   // a wall of 6 m under a pitch of 45°; a gable
  plan.cap = 20;
  const auto raised = mansard::extrude::raise(plan);
  if (!raised) return std::puts(raised.error().message.c_str()), 1;
  for (const auto& warning : raised->warnings) std::puts(warning.message.c_str());
  std::printf("%zu faces, %.1f m3\n", raised->solid.faces.size(), mansard::solid::volume(raised->solid));
}
