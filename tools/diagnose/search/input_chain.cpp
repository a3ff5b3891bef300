#include "tools/diagnose/search/input_chain.h"
#include <algorithm>
#include <bit>
#include "tools/diagnose/predict/derived_identity.h"

namespace loopwright::diagnosis {
namespace {

std::vector<const Member*> chain_of(const std::vector<Member>& members) {
  std::vector<const Member*> chain;
  for (const Member& member : members)
    if (member.candidate->acts == Acts::input) chain.push_back(&member);
  std::ranges::stable_sort(chain, {}, [](const Member* m) { return m->candidate->stage; });
  return chain;
}

/// Of the path behind a member, from that of the path ahead of it.
uint64_t identity_behind(uint64_t identity, const Member& member) {
  identity = derived_identity(identity, std::bit_cast<uintptr_t>(member.candidate));
  for (const auto* values : {&member.linear, &member.nonlinear})
    for (const double value : *values) identity = derived_identity(identity, std::bit_cast<uint64_t>(value));
  return identity;
}

}  // namespace

void add_columns(const Member& member, const Columns& columns, std::vector<double>& mean,
                 std::vector<double>& slope, double sign) {
  for (size_t c = 0; c < columns.size(); ++c) {
    const double amplitude = sign * member.linear[c];
    const std::vector<float>& mean_of = *columns[c].mean;
    for (size_t k = 0; k < mean.size(); ++k) mean[k] += amplitude * double(mean_of[k]);
    if (!columns[c].slope) continue;
    const std::vector<float>& slope_of = *columns[c].slope;
    slope.resize(mean.size(), 0.0);
    for (size_t k = 0; k < slope.size(); ++k) slope[k] += amplitude * double(slope_of[k]);
  }
}

ChangedInput InputChain::through(const std::vector<Member>& members) {
  const std::vector<const Member*> chain = chain_of(members);
  if (chain.empty()) return {raw_input_, path_.input_slope};
  if (!upstream_) upstream_ = path_;
  upstream_->input = raw_input_;
  upstream_->identity = derived_identity(path_.identity, 0);
  std::vector<double> slope = path_.input_slope;
  for (const Member* member : chain) {
    add_columns(*member, member->candidate->columns(*upstream_, member->nonlinear), upstream_->input, slope,
                -1);
    upstream_->identity = identity_behind(upstream_->identity, *member);
  }
  return {upstream_->input, std::move(slope)};
}

}  // namespace loopwright::diagnosis
