#include "tools/diagnose/search/own_shapes.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include "engine/diagram/formula_parser.h"
#include "tools/effects/site_effect.h"

namespace loopwright::diagnosis {
namespace {

/// Nats: as of a built-in shape with a parameter of its own.
constexpr double cost_of_own_shape = 2;

/// An effect with its formula compiled for a signal, its linear parameters and its others.
struct CompiledEffect {
  SiteEffect effect;
  FormulaParser parser;
  std::vector<double> values;
  size_t linear;
  std::mutex mutex;  // of parser and values: fits run on several threads

  explicit CompiledEffect(SiteEffect e)
      : effect(std::move(e)),
        values(effect.parameters.size() + 1),
        linear(size_t(std::ranges::count_if(effect.parameters, &SiteEffectParameter::is_linear))) {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("signal", &values[0]);
    for (size_t i = 0; i < effect.parameters.size(); ++i)
      parser.DefineVar(effect.parameters[i].name, &values[i + 1]);
    parser.set_formula(effect.formula);
  }
  CompiledEffect(const CompiledEffect&) = delete;

  /// With each linear parameter alone at one; a distortion has but one column.
  void columns(double signal, const double* own, double* column) {
    const std::lock_guard lock(mutex);
    values[0] = signal;
    for (size_t p = linear; p < effect.parameters.size(); ++p) values[p + 1] = own[p - linear];
    for (size_t c = 0; c < std::max<size_t>(1, linear); ++c) {
      for (size_t i = 0; i < linear; ++i) values[i + 1] = i == c ? 1 : 0;
      column[c] = parser.Eval();
    }
  }
};

Quantity quantity_called(const std::string& word) {
  using enum Quantity;
  static const std::map<std::string, Quantity> known = {{"position", position}, {"level", position},
                                                        {"velocity", velocity}, {"force", force},
                                                        {"torque", force},      {"heat", heat},
                                                        {"voltage", voltage},   {"current", current},
                                                        {"flow", flow},         {"temperature", temperature}};
  return known.at(word);
}

/// A signal without a unit may be anything.
bool is_one_of(const std::vector<std::string>& words, Quantity quantity) {
  return words.empty() || quantity == Quantity::other ||
         std::ranges::any_of(words, [&](const std::string& w) { return quantity_called(w) == quantity; });
}

SignalSizes sizes_of(std::span<const double> signal) {
  SignalSizes sizes;
  if (signal.empty()) return sizes;
  const auto [low, high] = std::ranges::minmax(signal);
  double square = 0;
  for (double s : signal) square += s * s;
  sizes.lowest = low, sizes.highest = high, sizes.largest = std::max(std::abs(low), std::abs(high));
  sizes.rms = std::sqrt(square / double(signal.size()));
  return sizes;
}

TermShape::Ranges ranges_of(const CompiledEffect& c, std::span<const double> signal) {
  TermShape::Ranges ranges;
  const SignalSizes sizes = sizes_of(signal);
  for (size_t p = c.linear; p < c.effect.parameters.size(); ++p) {
    const SignalRange range = range_of(c.effect.parameters[p], sizes);
    ranges.low[p - c.linear] = range.low, ranges.high[p - c.linear] = range.high;
  }
  return ranges;
}

/// The middles of as many equal parts of each range as it has points.
std::vector<std::array<double, most_nonlinear>> starts_of(const CompiledEffect& c,
                                                          std::span<const double> signal) {
  const TermShape::Ranges ranges = ranges_of(c, signal);
  std::vector<std::array<double, most_nonlinear>> list{{}};
  for (size_t p = c.linear; p < c.effect.parameters.size(); ++p) {
    const SiteEffectParameter& parameter = c.effect.parameters[p];
    const double low = ranges.low[p - c.linear], high = ranges.high[p - c.linear];
    std::vector<std::array<double, most_nonlinear>> longer;
    for (const auto& start : list)
      for (int i = 0; i < parameter.points; ++i) {
        const double part = (i + 0.5) / parameter.points;
        longer.push_back(start);
        longer.back()[p - c.linear] = parameter.is_logarithmic && low > 0 ? low * std::pow(high / low, part)
                                                                          : low + part * (high - low);
      }
    list = std::move(longer);
  }
  return list;
}

TermShape shape_of(const std::shared_ptr<CompiledEffect>& c) {
  const SiteEffect& effect = c->effect;
  TermShape shape;
  shape.name = effect.name, shape.title = effect.title, shape.formula = effect.formula;
  shape.of = effect.is_distortion ? TermShape::Of::own : TermShape::Of::signal;
  shape.columns = int(std::max<size_t>(1, c->linear)), shape.cost = cost_of_own_shape;
  for (size_t p = 0; p < effect.parameters.size(); ++p) {
    if (p < c->linear)
      shape.coefficients[p] = effect.parameters[p].name, shape.power = effect.parameters[p].power;
    else
      shape.nonlinear[p - c->linear] = effect.parameters[p].name;
  }
  shape.evaluate = [c](double signal, const double* own, double* column) { c->columns(signal, own, column); };
  shape.fits = [c](Quantity site, Quantity signal) {
    return is_one_of(c->effect.sites, site) && is_one_of(c->effect.signals, signal);
  };
  if (effect.parameters.size() > c->linear) {
    shape.starts = [c](std::span<const double> signal) { return starts_of(*c, signal); };
    shape.ranges = [c](std::span<const double> signal) { return ranges_of(*c, signal); };
  }
  return shape;
}

}  // namespace

ShapeCatalogue::ShapeCatalogue(const std::vector<std::string>& instead,
                               const std::vector<std::string>& more) {
  Problems problems;
  if (instead.empty()) shapes_.assign(named_shapes().begin(), named_shapes().end());
  std::vector<std::string> folders = instead;
  std::ranges::copy(more, std::back_inserter(folders));
  const std::vector<SiteEffect> effects = load_site_effects(folders, problems);
  if (!folders.empty() && effects.empty() && !problems.has_errors()) {
    auto& p = problems.error({}, "", "", "no effect in these folders acts at a site of a diagram");
    p.expected = "a file with \"site\": a kind of port, as docs/effects.md describes it";
    p.found = fmt::format("{}", fmt::join(folders, ", "));
    p.hint = "without roles in the experiment, effects of an axis have no meaning";
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  for (const SiteEffect& effect : effects) {
    const auto compiled = std::make_shared<CompiledEffect>(effect);
    kept_.push_back(compiled);
    std::erase_if(shapes_, [&](const TermShape& s) { return s.name == effect.name; });
    shapes_.push_back(shape_of(compiled));
  }
}

}  // namespace loopwright::diagnosis
