#include "tests/benchmarks/measure.h"
#include <fmt/format.h>
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace loopwright::benchmarks {
namespace {

std::vector<Figure>& figures() {
  static std::vector<Figure> all;
  return all;
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "not known";
}

bool is_met(const Figure& figure) {
  return (figure.bar == 0 || figure.value <= figure.bar) && figure.value >= figure.at_least;
}

}  // namespace

double cpu_time() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void report(benchmark::State& state, Figure figure) {
  state.counters["value"] = figure.value;
  if (figure.bar > 0) state.counters["bar"] = figure.bar;
  for (const auto& [name, value] : figure.details) state.counters[name] = value;
  figures().push_back(std::move(figure));
}

std::string report_text() {
  nlohmann::ordered_json json;
  json["processor"] = processor();
  json["compiler"] = fmt::format("g++ {}", __VERSION__);
  double load[1] = {0};
  if (getloadavg(load, 1) == 1) json["load"] = load[0];
  for (const Figure& figure : figures()) {
    auto& entry = json[figure.key];
    entry["value"] = figure.value;
    if (figure.bar > 0) entry["bar"] = figure.bar;
    if (figure.at_least > 0) entry["at_least"] = figure.at_least;
    if (figure.bar > 0 || figure.at_least > 0) entry["met"] = is_met(figure);
    entry["measured"] = figure.measured;
    for (const auto& [name, value] : figure.details) entry[name] = value;
  }
  return json.dump(2) + "\n";
}

std::vector<std::string> missed_bars() {
  std::vector<std::string> missed;
  for (const Figure& figure : figures())
    if (!is_met(figure)) missed.push_back(figure.key);
  return missed;
}

}  // namespace loopwright::benchmarks
