#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include "engine/block/registry.h"

namespace loopwright {
namespace {

/// The name in other programs, in lower case without spaces; the equivalent block here, if there is one;
/// additional information. A name is listed only if the block with the
/// most similar name is a different one.
struct Alias {
  std::string_view name, block, note;
};
constexpr Alias aliases[] = {
    {"abs", "Absolute", ""},
    {"bias", "Sum", "with a Constant"},
    {"busselector", "Unpack", ""},
    {"chart", "", "there is no state machine: put it together from Relay, Switch and Comparison"},
    {"chirpsignal", "Chirp", ""},
    {"damper", "ViscousFriction", ""},
    {"demux", "Unpack", ""},
    {"differentiator", "Derivative", ""},
    {"digitalclock", "Clock", ""},
    {"discretefilter", "DiscreteTransferFunction", ""},
    {"discretepidcontroller", "PidController", ""},
    {"discretetimeintegrator", "DiscreteIntegrator", ""},
    {"divide", "Product", "with \"operations\": \"*/\""},
    {"fcn", "Expression", ""},
    {"fromfile", "RecordedColumn", ""},
    {"fromworkspace", "RecordedColumn", ""},
    {"inertia", "Mass", "a torque as its force, an angle as its position"},
    {"inport", "", "inputs stand in the diagram's \"inputs\", not among its blocks"},
    {"lookuptable", "Lookup1D", ""},
    {"math", "Expression", ""},
    {"mathfunction", "Expression", ""},
    {"matlabfunction", "Expression", "or write a block of your own, docs/writing_blocks.md"},
    {"memory", "UnitDelay", ""},
    {"minmax", "Minimum", "or Maximum"},
    {"multiply", "Product", ""},
    {"mux", "Pack", ""},
    {"ode15s", "", "solvers stand in \"solver\": {\"method\": \"cvode-bdf\"}"},
    {"ode45", "", "solvers stand in \"solver\": {\"method\": \"dopri5\"}"},
    {"outport", "", "outputs stand in the diagram's \"outputs\", not among its blocks"},
    {"pd", "PdController", ""},
    {"pi", "PidController", "without its derivative"},
    {"pid", "PidController", ""},
    {"pulsegenerator", "PulseTrain", ""},
    {"randomnumber", "Noise", ""},
    {"relationaloperator", "Comparison", ""},
    {"sampleandhold", "ZeroOrderHold", ""},
    {"scope", "", "name the signal in the diagram's \"log\"; `loopwright run --report` shows it"},
    {"sin", "Expression", "with \"formula\": \"sin(x)\"; a source is a Sine"},
    {"sinewave", "Sine", ""},
    {"squarewave", "PulseTrain", ""},
    {"stateflow", "", "there is no state machine: put it together from Relay, Switch and Comparison"},
    {"subsystem", "", "a subdiagram is {\"diagram\": \"FILE.json\", \"in\": {…}}, without a type"},
    {"subtract", "Sum", "with \"signs\": \"+-\""},
    {"tofile", "", "name the signal in the diagram's \"log\"; `loopwright run -o FILE.csv` writes it"},
    {"toworkspace", "", "name the signal in the diagram's \"log\"; `loopwright run -o FILE.mat` writes it"},
    {"transferfcn", "TransferFunction", ""},
    {"trig", "Expression", "with \"formula\": \"sin(x)\""},
    {"trigonometricfunction", "Expression", "with \"formula\": \"sin(x)\""},
    {"uniformrandomnumber", "Noise", ""},
    {"whitenoise", "Noise", ""},
    {"zeropole", "TransferFunction", ""},
};

std::string plain(std::string_view type) {
  std::string name;
  for (const char c : type)
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += char(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

std::string block_type_hint(std::string_view type) {
  const std::string name = plain(type);
  const auto alias = std::ranges::find(aliases, name, &Alias::name);
  if (alias != std::end(aliases) && alias->block.empty()) return std::string(alias->note);
  if (alias != std::end(aliases))
    return fmt::format("did you mean \"{}\"{}{}?", alias->block, alias->note.empty() ? "" : ", ",
                       alias->note);
  std::vector<std::string> types;
  for (const auto& [known, unused] : all_blocks()) types.push_back(known);
  const std::string near = nearest_name(type, types);
  return near.empty() ? "`loopwright blocks` lists all types" : fmt::format("did you mean \"{}\"?", near);
}

}  // namespace loopwright
