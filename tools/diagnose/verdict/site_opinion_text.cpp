#include "tools/diagnose/verdict/site_opinion_text.h"
#include <fmt/format.h>
#include "tools/diagnose/wording.h"

namespace loopwright::diagnosis {
namespace {

std::string missed(const std::optional<double>& error, const std::string& unit) {
  return error ? fmt::format("misses {}", shown(*error, unit)) : "diverges";
}

}  // namespace

void tell_second_opinion(const SiteModel& model, const SecondOpinion& opinion, Diagnosis& result) {
  std::vector<std::string> noisy;
  for (const NoisySite& site : opinion.noisy)
    noisy.push_back(fmt::format("{:.0f} % of {}", 100 * site.share, model.sites()[size_t(site.site)].name));
  std::vector<std::string> unmeasured;
  for (int state : opinion.unmeasured) unmeasured.push_back(model.state_name(state));
  RecordFinding finding;
  finding.what = fmt::format(
      "noise of {} in every sample would explain it whatever the diagram lacks (not measured: {})",
      loopwright::joined(noisy, " and "), loopwright::joined(unmeasured, ", "));
  const std::string& unit = model.record().outputs.front().unit;
  const std::string other = opinion.other.empty() ? "nothing" : loopwright::joined(opinion.other, " + ");
  if (opinion.is_lost)
    finding.cost =
        "free simulations cannot be asked about it: along this record a small deviation grows until nothing "
        "is left of what caused it";
  else if (opinion.is_not_asked)
    finding.cost = "the search had used up its operations before free simulations could be asked about it";
  else if (opinion.is_answer)
    finding.cost = fmt::format(
        "the answer is that of free simulations, with which one {}; by predictions of one sample {} would be "
        "named, with which it {}",
        missed(opinion.error, unit), other, missed(opinion.other_error, unit));
  else if (opinion.agrees && opinion.idle.empty())
    finding.cost = "free simulations ask for the same";
  else if (opinion.agrees)
    finding.cost = fmt::format("free simulations ask for the same, and for {}, with which they miss no less",
                               loopwright::joined(opinion.idle, " + "));
  else
    finding.cost = fmt::format(
        "free simulations would name {}; with that one {}, with the answer it {}: {}", other,
        missed(opinion.other_error, unit), missed(opinion.error, unit),
        opinion.predicts_worse ? "but it predicts the record much worse" : "that decides nothing");
  result.findings.push_back(std::move(finding));
}

}  // namespace loopwright::diagnosis
