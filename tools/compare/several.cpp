#include "tools/compare/several.h"
#include <fmt/format.h>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include "tools/experiment/experiment_ports.h"
#include "tools/report/typography.h"

namespace loopwright {
namespace {

/// Root mean squares over all rows of all records, with their unit: signals by name, and the residual force.
struct Pool {
  double sum = 0, rows = 0;
  std::string unit;
  double rms() const { return rows > 0 ? std::sqrt(sum / rows) : 0; }
};
struct Together {
  std::map<std::string, Pool> signals;
  Pool force;
};
Together pooled(const SeveralComparisons& several) {
  Together all;
  for (const Comparison& c : several.records) {
    for (const ComparedSignal& s : c.signals) {
      Pool& pool = all.signals[s.name];
      pool.unit = s.unit, pool.rows += double(s.error.size());
      for (double e : s.error) pool.sum += e * e;
    }
    if (!c.force) continue;
    all.force.unit = c.force->motion.force_unit;
    for (size_t k = 0; k < c.force->residual.value.size(); ++k)
      if (c.force->motion.counts[k])
        all.force.sum += c.force->residual.value[k] * c.force->residual.value[k], all.force.rows += 1;
  }
  return all;
}

std::string shown(const Pool& pool) {
  const report::Quantity q = report::engineering(pool.rms(), pool.unit);
  return q.value + " " + q.unit;
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

}  // namespace

SeveralComparisons compare(const std::string& diagram, const std::vector<std::string>& experiments,
                           const LoadOptions& options, const RunOptions& run_options) {
  SeveralComparisons several{experiments, {}, {}, {}};
  try {
    for (const std::string& experiment : experiments)
      several.records.push_back(compare(diagram, experiment, options, run_options));
  } catch (InputError& error) {
    explain_failure(diagram, experiments, options, std::move(error.problems));
  }
  std::vector<RecordView> views;
  for (const Comparison& c : several.records)
    if (c.force) views.push_back({c.force->motion, c.force->residual, c.force->content});
  if (views.empty() || several.records.size() < 2) return several;
  several.faults = faults_of(views);
  Problems problems;  // of the catalogue: every single comparison has reported them
  several.identifiable = identifiable(content_of(views), load_catalogue({catalogue_folder()}, problems));
  for (Comparison& c : several.records)
    if (c.force) c.force->faults.clear(), c.force->identifiable.clear();
  return several;
}

std::string to_json(const SeveralComparisons& several) {
  if (several.records.size() == 1) return to_json(several.records.front());
  nlohmann::ordered_json json;
  for (size_t r = 0; r < several.records.size(); ++r) {
    nlohmann::ordered_json own{{"experiment", several.experiments[r]}};
    own.update(nlohmann::ordered_json::parse(to_json(several.records[r])));
    json["records"].push_back(std::move(own));
  }
  const Together all = pooled(several);
  auto& together = json["together"];
  for (const auto& [name, pool] : all.signals)
    together["signals"][name] = {{"rmse", pool.rms()}, {"unit", pool.unit}};
  if (all.force.rows > 0) together["force_residual"] = {{"rmse", all.force.rms()}, {"unit", all.force.unit}};
  together["faults"] = nlohmann::ordered_json::array();
  for (const RecordFault& fault : several.faults)
    together["faults"].push_back({{"name", fault.name}, {"text", fault.text}, {"cost", fault.cost}});
  for (const Identifiability& entry : several.identifiable)
    together["effects"][entry.effect] = {{"can_be_found", entry.can_be_found}, {"lacks", entry.lacks}};
  return json.dump(2) + "\n";
}

std::string to_text(const SeveralComparisons& several) {
  if (several.records.size() == 1) return to_text(several.records.front());
  std::string text;
  for (size_t r = 0; r < several.records.size(); ++r)
    text += fmt::format("{}. {}\n{}\n", r + 1, several.experiments[r], to_text(several.records[r]));
  const Together all = pooled(several);
  text += "all records together\n";
  for (const auto& [name, pool] : all.signals) text += fmt::format("  {}: {} rms\n", name, shown(pool));
  if (all.force.rows > 0) text += fmt::format("  force that the model lacks: {} rms\n", shown(all.force));
  std::string missing;
  for (const Identifiability& entry : several.identifiable)
    if (!entry.can_be_found) missing += fmt::format("    {}: needs {}\n", entry.effect, entry.lacks);
  if (!missing.empty()) text += "  these records cannot identify\n" + missing;
  for (const RecordFault& fault : several.faults)
    text += fmt::format("  the records: {}; {}\n", fault.text, fault.cost);
  return text;
}

report::Page comparison_page(const SeveralComparisons& several, const std::string& title) {
  if (several.records.size() == 1)
    return comparison_page(several.records.front(), title + " — " + file_name(several.experiments.front()));
  report::Page page;
  page.title = title;
  for (size_t r = 0; r < several.records.size(); ++r) {
    report::Page own = comparison_page(several.records[r], title);
    page.subtitle = own.subtitle;
    if (r == 0) page.facts = own.facts;
    if (r + 1 < several.records.size()) own.sections.pop_back();  // the diagram once
    for (report::Section& section : own.sections) {
      if (&section != &own.sections.back() || r + 1 < several.records.size())
        section.title = file_name(several.experiments[r]) + ": " + section.title;
      page.sections.push_back(std::move(section));
    }
  }
  for (const RecordFault& fault : several.faults)
    page.sections.front().items.push_back(report::Notice{
        report::Notice::Severity::warning, fmt::format("All records: {}. {}.", fault.text, fault.cost)});
  return page;
}

}  // namespace loopwright
