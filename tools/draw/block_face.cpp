#include "tools/draw/block_face.h"
#include <cmath>
#include <fmt/format.h>
#include "tools/report/typography.h"

namespace loopwright {
namespace {

using report::GraphFace;
using Shape = GraphFace::Shape;

std::string superscript(int number) {
  static constexpr std::string_view digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) out += digits[size_t(c - '0')];
  return out;
}

/// "2 s² + 0.3 s + 1": coefficients from the highest power down. `variable` is s or z; powers of 1/z rise
/// from 0. Long polynomials show their first and last term.
std::string polynomial(const std::vector<double>& coefficients, std::string_view variable, bool rises) {
  constexpr size_t most_terms = 3;
  std::vector<std::string> terms;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0) continue;
    const int power = rises ? -int(i) : int(coefficients.size() - 1 - i);
    const std::string symbol = power == 0   ? ""
                               : power == 1 ? std::string(variable)
                                            : std::string(variable) + superscript(power);
    const double size = std::abs(coefficients[i]);
    const std::string number = size == 1 && power != 0 ? "" : fmt::format("{:.4g}", size);
    const std::string sign = coefficients[i] < 0 ? "−" : terms.empty() ? "" : "+";
    terms.push_back(sign + (terms.empty() ? "" : " ") + number +
                    (number.empty() || symbol.empty() ? "" : " ") + symbol);
  }
  if (terms.empty()) return "0";
  if (terms.size() > most_terms) terms = {terms.front(), "+ …", terms.back()};
  std::string out = terms.front();
  for (size_t i = 1; i < terms.size(); ++i) out += " " + terms[i];
  return out;
}

GraphFace fraction(std::string numerator, std::string denominator, std::string text = {}) {
  GraphFace face;
  face.numerator = std::move(numerator), face.denominator = std::move(denominator);
  face.text = std::move(text);
  return face;
}

GraphFace text_face(std::string text, Shape shape = Shape::box) {
  GraphFace face;
  face.shape = shape;
  face.text = std::move(text);
  return face;
}

/// "Kp 3 N/m" for each of the parameters that is a number other than zero and infinity.
std::string listed(const ShownSettings& settings, std::initializer_list<std::string_view> parameters) {
  std::string lines;
  for (const std::string_view parameter : parameters) {
    const double value = settings.number(parameter);
    if (!std::isfinite(value) || value == 0) continue;
    std::string name(parameter);
    std::ranges::replace(name, '_', ' ');
    lines += fmt::format("{}{} {}", lines.empty() ? "" : "\n", name, settings.quantity(parameter));
  }
  return lines;
}

/// Blocks of linear dynamics, as fractions.
std::optional<GraphFace> dynamics(const ShownSettings& s) {
  const std::string& type = s.type();
  if (type == "Integrator") return fraction("1", "s");
  if (type == "Derivative") return fraction("s", "1 + s/ω", "ω " + s.quantity("cutoff"));
  if (type == "LowPass")
    return text_face(fmt::format("low-pass {}\n{}", s.text("order"), s.quantity("cutoff")));
  if (type == "TransferFunction" || type == "StrictlyProperTransferFunction")
    return fraction(polynomial(s.numbers("numerator"), "s", false),
                    polynomial(s.numbers("denominator"), "s", false));
  if (type == "DiscreteTransferFunction")
    return fraction(polynomial(s.numbers("numerator"), "z", true),
                    polynomial(s.numbers("denominator"), "z", true));
  if (type == "DiscreteIntegrator") {
    const std::string method = s.text("method");
    if (method == "forward") return fraction("T", "z − 1");
    if (method == "backward") return fraction("T z", "z − 1");
    return fraction("T (z + 1)", "2 (z − 1)");
  }
  if (type == "DiscreteDerivative") return fraction("z − 1", "T z");
  if (type == "UnitDelay") return fraction("1", "z");
  if (type == "Delay") return text_face("z" + superscript(-int(s.number("samples"))));
  if (type == "TransportDelay" || type == "FractionalDelay")
    return text_face("e⁻ˢᵀ" + (std::isnan(s.number("delay")) ? "" : "\nT " + s.quantity("delay")));
  if (type == "StateSpace" || type == "StrictlyProperStateSpace")
    return text_face(type == "StateSpace" ? "ẋ = Ax + Bu\ny = Cx + Du" : "ẋ = Ax + Bu\ny = Cx");
  if (type == "DiscreteStateSpace") return text_face("x⁺ = Ax + Bu\ny = Cx + Du");
  if (type == "Mass") return fraction("1", "m s²", "m " + s.quantity("mass"));
  if (type == "ActuatorLag") return text_face(listed(s, {"time_constant"}));
  return std::nullopt;
}

/// Controllers and filters show what they are tuned with.
std::string tuning(const ShownSettings& s) {
  if (s.room() != "control") return {};
  return listed(s, {"Kp", "Ki", "Kd", "proportional", "integral", "derivative", "cutoff", "center",
                    "frequency", "width", "mass", "damping", "zero", "pole", "gain", "time_constant"});
}

/// Laws of force show their first parameter beside their characteristic.
std::string level(const ShownSettings& s) {
  if (s.room() != "mechanics") return {};
  for (const std::string_view parameter : {"level", "damping", "drag", "stiffness", "gap", "static_level"})
    if (std::isfinite(s.number(parameter))) return s.quantity(parameter);
  return {};
}

}  // namespace

report::GraphFace block_face(const ShownSettings& s, size_t inputs) {
  const std::string& type = s.type();
  if (type == "Sum") return text_face(inputs <= 2 ? "" : "Σ", inputs <= 2 ? Shape::circle : Shape::box);
  if (type == "Product") return text_face(inputs <= 2 ? "×" : "Π", inputs <= 2 ? Shape::circle : Shape::box);
  if (type == "Gain") return text_face(s.quantity("gain").empty() ? "K" : s.quantity("gain"), Shape::gain);
  if (type == "MatrixGain") return text_face("K", Shape::gain);
  if (type == "Constant") return text_face(s.quantity("value"));
  if (type == "Expression") return text_face(s.text("formula"));
  if (type == "Comparison") return text_face(s.text("operator"));
  if (type == "Maximum") return text_face("max");
  if (type == "Minimum") return text_face("min");
  if (type == "Absolute") return text_face("|u|");
  if (auto face = dynamics(s)) return *face;
  GraphFace face;
  face.strokes = characteristic(s);
  face.has_axes = !face.strokes.empty() && s.room() != "sources";
  face.text = face.strokes.empty() ? tuning(s) : level(s);
  return face;
}

std::vector<std::string> wire_signs(const ShownSettings& s, size_t wires) {
  std::vector<std::string> signs(wires);
  const bool is_sum = s.type() == "Sum", is_product = s.type() == "Product";
  if (!is_sum && !is_product) return signs;
  const std::string written = s.text(is_sum ? "signs" : "operations");
  for (size_t i = 0; i < wires; ++i) {
    const char sign = i < written.size() ? written[i] : is_sum ? '+' : '*';
    signs[i] = sign == '-' ? "−" : sign == '/' ? "÷" : is_product ? "×" : "+";
  }
  return signs;
}

}  // namespace loopwright
