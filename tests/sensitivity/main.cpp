// Diagnoses of records with a threshold of the diagnosis multiplied by a factor:
//   sensitivity THRESHOLD FACTOR FOLDER...     FOLDER has diagram.json and record.experiment.json
// Writes FOLDER/answer.THRESHOLD.FACTOR.json.
#include <fmt/format.h>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/diagnose.h"

using namespace loopwright;

namespace {

void multiply(std::string_view name, double factor) {
  for (const diagnosis::criteria::Threshold& t : diagnosis::criteria::all_thresholds()) {
    if (t.name != name) continue;
    for (double& number : t.numbers) number *= factor;
    if (t.whole) *t.whole = int(std::lround(*t.whole * factor));
    if (t.count) *t.count = size_t(std::lround(double(*t.count) * factor));
    return;
  }
  throw std::invalid_argument(fmt::format("no threshold \"{}\"", name));
}

}  // namespace

int main(int count, char** arguments) try {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() < 3) throw std::invalid_argument("expected THRESHOLD FACTOR FOLDER...");
  multiply(given[0], std::stod(given[1]));
  for (size_t i = 2; i < given.size(); ++i) {
    const Diagnosis d = diagnose(given[i] + "/diagram.json", {given[i] + "/record.experiment.json"});
    std::ofstream(fmt::format("{}/answer.{}.{}.json", given[i], given[0], given[1])) << to_json(d);
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 2;
}
