#include "engine/diagram/formula_steps.h"

#include <bit>
#include <numbers>
#include <utility>

#include "engine/diagram/formula_functions.h"
#include "engine/diagram/formula_parser.h"

namespace loopwright {
namespace {

using Math = mu::MathImpl<double>;

double less(double a, double b) { return a < b; }
double greater(double a, double b) { return a > b; }
double at_most(double a, double b) { return a <= b; }
double at_least(double a, double b) { return a >= b; }
double equal(double a, double b) { return a == b; }
double unequal(double a, double b) { return a != b; }
double both(double a, double b) { return a && b; }
double either(double a, double b) { return a || b; }

}  // namespace

/// Executes a formula by muParser with the places of values in the place of the values.
class FormulaNotes {
 public:
  explicit FormulaNotes(size_t variables) {
    steps_.values_.assign(variables, 0), steps_.variables_ = variables;
  }

  double number(double value) {
    for (size_t i = steps_.variables_; i < steps_.values_.size(); ++i)
      if (std::bit_cast<uint64_t>(steps_.values_[i]) == std::bit_cast<uint64_t>(value) && is_number(i))
        return double(i);
    steps_.values_.push_back(value);
    return double(steps_.values_.size() - 1);
  }
  double note(double (*one)(double), double a) {
    Step step{Kind::one, 0, int(a), 0, {}};
    step.one = one;
    return place_of(step);
  }
  double note(double (*two)(double, double), double a, double b) {
    Step step{Kind::two, 0, int(a), int(b), {}};
    step.two = two;
    return place_of(step);
  }
  double note(double (*many)(const double*, int), const double* a, int count) {
    Step step{Kind::many, 0, int(steps_.arguments_.size()), count, {}};
    step.many = many;
    for (int i = 0; i < count; ++i) steps_.arguments_.push_back(int(a[i]));
    return place_of(step);
  }
  double note(FormulaSteps::Kind arithmetic, double a, double b) {
    return place_of({arithmetic, 0, int(a), int(b), {}});
  }
  FormulaSteps of_result(double place) {
    steps_.result_ = int(place);
    steps_.keep_constant_from(steps_.variables_);
    return std::move(steps_);
  }

  using Kind = FormulaSteps::Kind;
  static thread_local FormulaNotes* now;  // muParser passes nothing to what it calls

 private:
  using Step = FormulaSteps::Step;
  bool is_number(size_t place) const {
    return std::ranges::none_of(steps_.all_, [&](const Step& s) { return size_t(s.to) == place; });
  }
  double place_of(Step step) {
    for (const Step& known : steps_.all_) {
      step.to = known.to;
      if (known == step) return double(known.to);
    }
    step.to = int(steps_.values_.size());
    steps_.values_.push_back(0), steps_.all_.push_back(step);
    return double(step.to);
  }

  FormulaSteps steps_;
};
thread_local FormulaNotes* FormulaNotes::now = nullptr;

namespace {

template <auto function> struct Noted;
template <double (*f)(double)> struct Noted<f> {
  static double call(double a) { return FormulaNotes::now->note(f, a); }
};
template <double (*f)(double, double)> struct Noted<f> {
  static double call(double a, double b) { return FormulaNotes::now->note(f, a, b); }
};
template <double (*f)(const double*, int)> struct Noted<f> {
  static double call(const double* a, int count) { return FormulaNotes::now->note(f, a, count); }
};
template <FormulaNotes::Kind kind> struct Noted<kind> {
  static double call(double a, double b) { return FormulaNotes::now->note(kind, a, b); }
};

/// Knows only what it notes: a formula with anything else cannot be read.
class NotingParser : public mu::Parser {
 public:
  NotingParser() {
    EnableBuiltInOprt(false), ClearFun(), ClearConst(), ClearInfixOprt();
    define_own_functions<Noted>(*this);
    DefineFun("sqrt", Noted<&Math::Sqrt>::call);
    DefineFun("abs", Noted<&Math::Abs>::call);
    DefineFun("sign", Noted<&Math::Sign>::call);
    DefineFun("rint", Noted<&Math::Rint>::call);
    DefineFun("min", Noted<&Math::Min>::call);
    DefineFun("max", Noted<&Math::Max>::call);
    DefineFun("sum", Noted<&Math::Sum>::call);
    DefineFun("avg", Noted<&Math::Avg>::call);
    DefineInfixOprt("-", Noted<&Math::UnaryMinus>::call);
    DefineInfixOprt("+", Noted<&Math::UnaryPlus>::call);
    using Kind = FormulaNotes::Kind;
    define("+", Noted<Kind::add>::call, mu::prADD_SUB),
        define("-", Noted<Kind::subtract>::call, mu::prADD_SUB);
    define("*", Noted<Kind::multiply>::call, mu::prMUL_DIV),
        define("/", Noted<Kind::divide>::call, mu::prMUL_DIV);
    define("<", Noted<&less>::call, mu::prCMP), define(">", Noted<&greater>::call, mu::prCMP);
    define("<=", Noted<&at_most>::call, mu::prCMP), define(">=", Noted<&at_least>::call, mu::prCMP);
    define("==", Noted<&equal>::call, mu::prCMP), define("!=", Noted<&unequal>::call, mu::prCMP);
    define("&&", Noted<&both>::call, mu::prLAND), define("||", Noted<&either>::call, mu::prLOR);
    AddValIdent([](const char* text, int* position, double* value) {
      const int is_one = IsVal(text, position, value);
      if (is_one) *value = FormulaNotes::now->number(*value);
      return is_one;
    });
  }

 private:
  void define(const char* name, double (*call)(double, double), int precedence) {
    DefineOprt(name, call, unsigned(precedence), mu::oaLEFT, false);
  }
};

/// Whether both compute the same bits at some values, at one of them a number.
bool agree(FormulaSteps steps, const std::string& formula, const std::vector<std::string_view>& names) {
  constexpr double tried[] = {0.37, -1.9, 2.3e-4, 41.7, -0.61};
  std::vector<double> values(names.size());
  FormulaParser parser;
  parser.DefineConst("pi", std::numbers::pi);
  for (size_t i = 0; i < names.size(); ++i) parser.DefineVar(std::string(names[i]), &values[i]);
  parser.set_formula(formula);
  bool is_number = false;
  for (size_t k = 0; k < std::size(tried); ++k) {
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = steps.variables()[i] = tried[(k + i) % std::size(tried)] * double(1 + i / std::size(tried));
    steps.keep_constant_from(values.size());
    const double a = steps.value(), b = parser.Eval();
    if (std::isnan(a) && std::isnan(b)) continue;
    if (std::bit_cast<uint64_t>(a) != std::bit_cast<uint64_t>(b)) return false;
    is_number = true;
  }
  return is_number;
}

}  // namespace

bool FormulaSteps::Step::operator==(const Step& other) const {
  if (kind != other.kind || first != other.first || second != other.second || kind == Kind::many)
    return false;
  return kind == Kind::one ? one == other.one : kind == Kind::two ? two == other.two : true;
}

std::optional<FormulaSteps> FormulaSteps::of(const std::string& formula,
                                             const std::vector<std::string_view>& names) {
  if (formula.find('?') != formula.npos) return {};  // muParser goes one of two ways
  FormulaNotes notes(names.size());
  FormulaNotes* const before = std::exchange(FormulaNotes::now, &notes);
  std::optional<FormulaSteps> steps;
  try {
    NotingParser parser;
    std::vector<double> places(names.size());
    for (size_t i = 0; i < names.size(); ++i)
      places[i] = double(i), parser.DefineVar(std::string(names[i]), &places[i]);
    double half_turn = notes.number(std::numbers::pi), of_muparser = notes.number(Math::CONST_PI),
           e = notes.number(Math::CONST_E);
    parser.DefineVar("pi", &half_turn), parser.DefineVar("_pi", &of_muparser), parser.DefineVar("_e", &e);
    parser.SetExpr(as_parsed(formula));
    steps = notes.of_result(parser.Eval());
    if (!agree(*steps, formula, names)) steps.reset();
  } catch (const mu::ParserError&) {  // what it does not know
    steps.reset();
  }
  FormulaNotes::now = before;
  return steps;
}

[[gnu::always_inline]] inline void FormulaSteps::execute(const Step& step) {
  const double a = values_[size_t(step.kind == Kind::many ? 0 : step.first)];
  double& to = values_[size_t(step.to)];
  switch (step.kind) {
    case Kind::add:
      to = a + values_[size_t(step.second)];
      return;
    case Kind::subtract:
      to = a - values_[size_t(step.second)];
      return;
    case Kind::multiply:
      to = a * values_[size_t(step.second)];
      return;
    case Kind::divide:
      to = a / values_[size_t(step.second)];
      return;
    case Kind::one:
      to = step.one(a);
      return;
    case Kind::two:
      to = step.two(a, values_[size_t(step.second)]);
      return;
    case Kind::many:
      for (int i = 0; i < step.second; ++i)
        collected_[size_t(step.first + i)] = values_[size_t(arguments_[size_t(step.first + i)])];
      to = step.many(&collected_[size_t(step.first)], step.second);
      return;
  }
}

void FormulaSteps::keep_constant_from(size_t first) {
  std::vector<bool> changes(values_.size(), false);
  std::fill_n(changes.begin(), std::min(first, variables_), true);
  const auto depends_on_changes = [&](const Step& step) {
    if (step.kind != Kind::many)
      return changes[size_t(step.first)] || (step.kind != Kind::one && changes[size_t(step.second)]);
    return std::any_of(&arguments_[size_t(step.first)], &arguments_[size_t(step.first)] + step.second,
                       [&](int place) { return bool(changes[size_t(place)]); });
  };
  steps_.clear();
  collected_.resize(arguments_.size());
  for (const Step& step : all_)
    if ((changes[size_t(step.to)] = depends_on_changes(step)))
      steps_.push_back(step);
    else
      execute(step);
}

double FormulaSteps::value() {
  for (const Step& step : steps_) execute(step);
  return values_[size_t(result_)];
}

}  // namespace loopwright
