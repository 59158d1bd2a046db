// The rows that an interrupted map left behind.

#include <fstream>
#include <string>

#include "map_file.hpp"
#include "scratch.hpp"
#include "targets.hpp"
#include "tribofit/study/map.hpp"

namespace tribofit::fuzz {
namespace {

constexpr std::size_t kColumns = 3, kRows = 2;

MapRequest small_map() {
  Machine machine;
  machine.rig = {1, 10, 1e4};
  machine.load = 50;
  machine.radius = 0.015;
  machine.speed = 0.4;
  machine.model = FrictionModel(ExponentialLaw{});
  machine.parameters = {0.5, 0.3, 100};
  return {machine,
          {variable_named(machine, "velocity"), {1e-3, 2e-3, 3e-3}},
          {variable_named(machine, "ratio"), {0.3, 0.6}},
          {}};
}

/// The line that says of what map the rows are.
std::string head_of(const Folder& scratch, const MapRequest& request) {
  const MapFile begun(scratch.path(), request, true);
  std::ifstream in(scratch.path() + "/map.rows");
  std::string line;
  std::getline(in, line);
  return line + "\n";
}

}  // namespace

void read_map_bytes(std::string_view bytes) {
  static const Folder scratch;
  static const MapRequest request = small_map();
  static const std::string head = head_of(scratch, request);
  scratch.write("map.rows", head + std::string(bytes));
  const MapFile found(scratch.path(), request, false);
  for (std::size_t row = 0; row < kRows; ++row) {
    require(found.rows()[row].size() == (found.done()[row] ? kColumns : 0));
    for (const MapCell& cell : found.rows()[row]) require(cell.values.size() == measures().size());
  }
}

}  // namespace tribofit::fuzz
