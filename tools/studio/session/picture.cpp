#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/studio/session/checked_text.h"
#include "tools/studio/session/setting_text.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

std::string number_text(const Value& settings, std::string_view name) {
  const Value::Member* member = settings.find(name);
  return member ? shown_value(member->value, "") : "";
}

double number_of(const Value& settings, std::string_view name, double otherwise) {
  const Value::Member* member = settings.find(name);
  return member && member->value.kind == Kind::number ? member->value.number : otherwise;
}

std::vector<double> numbers_of(const Value& settings, std::string_view name) {
  std::vector<double> numbers;
  if (const Value::Member* member = settings.find(name))
    for (const Value& item : member->value.items)
      if (item.kind == Kind::number) numbers.push_back(item.number);
  return numbers;
}

std::string raised(const std::string& variable, size_t power, bool is_inverse) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (power == 0) return "";
  std::string text = variable;
  if (power == 1 && !is_inverse) return text;
  if (is_inverse) text += "⁻";
  for (char digit : fmt::format("{}", power)) text += digits[size_t(digit - '0')];
  return text;
}

/// In falling powers of s, or rising powers of 1/z.
std::string polynomial(const std::vector<double>& coefficients, bool is_discrete) {
  std::string text;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    const double c = coefficients[i];
    if (c == 0) continue;
    const std::string power =
        is_discrete ? raised("z", i, true) : raised("s", coefficients.size() - 1 - i, false);
    const std::string size = std::abs(c) == 1 && !power.empty() ? "" : fmt::format("{:.4g}", std::abs(c));
    text += text.empty() ? (c < 0 ? "−" : "") : (c < 0 ? " − " : " + ");
    text += size + (size.empty() || power.empty() ? "" : " ") + power;
  }
  return text.empty() ? "0" : text;
}

Json fraction(const std::string& numerator, const std::string& denominator) {
  return {{"kind", "fraction"}, {"numerator", numerator}, {"denominator", denominator}};
}
Json text(const std::string& shown) {
  if (shown.empty()) return {{"kind", "none"}};
  return {{"kind", "text"}, {"text", shown}};
}
Json curve(const std::vector<double>& x, const std::vector<double>& y) {
  return {{"kind", "curve"}, {"x", x}, {"y", y}};
}

Json limits(double low, double high, bool is_dead_zone) {
  if (!(low < high)) return {{"kind", "none"}};
  const double margin = 0.5 * (high - low);
  if (is_dead_zone) return curve({low - margin, low, high, high + margin}, {-margin, 0, 0, margin});
  return curve({low - margin, low, high, high + margin}, {low, low, high, high});
}

Json transfer(const Value& settings, bool is_discrete) {
  const std::vector<double> numerator = numbers_of(settings, "numerator"),
                            denominator = numbers_of(settings, "denominator");
  if (denominator.empty()) return {{"kind", "none"}};
  return fraction(polynomial(numerator, is_discrete), polynomial(denominator, is_discrete));
}

/// The setting that says most about a block of a type.
struct Telling {
  std::string_view type, setting;
};
constexpr Telling telling[] = {
    {"Gain", "gain"},
    {"Constant", "value"},
    {"Step", "after"},
    {"Mass", "mass"},
    {"ViscousFriction", "damping"},
    {"Spring", "stiffness"},
    {"CoulombFriction", "level"},
    {"LowPass", "cutoff"},
    {"Expression", "formula"},
    {"Comparison", "operator"},
    {"Logic", "operation"},
    {"Encoder", "resolution"},
    {"Ramp", "slope"},
    {"Sine", "frequency"},
    {"Quantizer", "interval"},
    {"TransportDelay", "delay"},
};

}  // namespace

Json picture_json(const std::string& type, const Value& settings) {
  if (type == "Sum" || type == "Product") {
    const std::string_view given = text_in(settings, type == "Sum" ? "signs" : "operations");
    return {{"kind", "signs"}, {"signs", given.empty() ? (type == "Sum" ? "+" : "*") : given}};
  }
  if (type.ends_with("TransferFunction")) return transfer(settings, type.starts_with("Discrete"));
  if (type == "Integrator") return fraction("1", "s");
  if (type == "Derivative") return text("d/dt");
  if (type == "UnitDelay") return text("z⁻¹");
  if (type == "Saturation" || type == "DeadZone")
    return limits(number_of(settings, "low", 0), number_of(settings, "high", 0), type == "DeadZone");
  if (type == "Lookup1D") {
    const std::vector<double> x = numbers_of(settings, "breakpoints"), y = numbers_of(settings, "values");
    if (x.size() == y.size() && x.size() > 1) return curve(x, y);
  }
  if (type == "Sign") return curve({-1, 0, 0, 1}, {-1, -1, 1, 1});
  if (type == "Absolute") return curve({-1, 0, 1}, {1, 0, 1});
  const auto found = std::ranges::find(telling, type, &Telling::type);
  return found == std::end(telling) ? Json{{"kind", "none"}} : text(number_text(settings, found->setting));
}

}  // namespace loopwright::studio
