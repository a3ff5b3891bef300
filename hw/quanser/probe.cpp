#include "hw/quanser/probe.h"
#include <fmt/format.h>
#include <cmath>
#include <ctime>
#include "hw/quanser/card_in_use.h"
#include "hw/quanser/errors.h"
#include "hw/quanser/library.h"
#include "models/real/whole.h"

namespace loopwright::hw::quanser {
namespace {

std::string shown(t_error result) {
  if (result >= 0) return fmt::format("accepted ({})", result);
  const std::string_view name = error_name(result);
  return fmt::format("{}{}{}", result, name.empty() ? "" : " ", name);
}

void pause_s(double seconds) {
  const timespec time{whole_between<time_t>(seconds, 0, 1000),
                      whole_between(1e9 * (seconds - std::floor(seconds)), 0L, 999'999'999L)};
  nanosleep(&time, nullptr);
}

class Probe {
 public:
  Probe(const Settings& settings, const Library& library,
        const std::function<bool(const std::string&)>& may_take_over)
      : settings_(settings), library_(library), call_(library.functions), may_take_over_(may_take_over) {}

  std::vector<ProbeAnswer> run(bool may_touch) {
    ask_library();
    if (open()) {
      ask_properties();
      if (may_touch) touch();
      call_.hil_close(card_);
    }
    return std::move(answers_);
  }

 private:
  void tell(std::string question, std::string answer, bool is_good = true) {
    answers_.push_back({std::move(question), std::move(answer), is_good});
  }
  /// Calls a function that the library may lack.
  template <class F, class... A> t_error ask(F* function, A... arguments) {
    return function ? function(arguments...) : -94;
  }

  void ask_library() {
    tell("library", library_.path);
    t_version version{sizeof(t_version), 0, 0, 0, 0};
    if (ask(call_.hil_get_version, &version) == 0)
      tell("version",
           fmt::format("{}.{}.{}.{}", version.major, version.minor, version.release, version.build));
    tell("optional functions that it lacks",
         library_.missing.empty() ? "none" : fmt::format("{}", fmt::join(library_.missing, ", ")));
    tell("texts of errors",
         call_.msg_get_error_messageA ? "from the library" : "from our own table of names");
  }

  bool open() {
    t_error result = call_.hil_open(settings_.board.c_str(), settings_.identifier.c_str(), &card_);
    const bool is_in_use = result < 0 && classify(result, false) == Code::busy;
    const std::string who = is_in_use ? who_has(settings_, library_, result) : "";
    if (is_in_use && call_.hil_close_all && may_take_over_ && may_take_over_(who)) {
      tell("taking it over", shown(call_.hil_close_all()));
      result = call_.hil_open(settings_.board.c_str(), settings_.identifier.c_str(), &card_);
    }
    const bool has_driver = result >= 0 || (result != -986 && result != -179 && result != -15);
    tell(fmt::format("driver of the {}", settings_.board),
         has_driver ? "there is one" : "none: " + shown(result), has_driver);
    if (has_driver)
      tell(fmt::format("card {}", settings_.identifier),
           result >= 0 ? "opened"
           : is_in_use ? "in use: " + who
                       : shown(result),
           result >= 0);
    return result >= 0;
  }

  void ask_properties() {
    for (const auto& [name, property] :
         {std::pair{"product", property_product_name}, std::pair{"serial number", property_serial_number},
          std::pair{"firmware", property_firmware}}) {
      char text[128] = "";
      const t_error result = ask(call_.hil_get_string_property, card_, property, text, sizeof text);
      tell(name, result < 0 ? shown(result) : text);
    }
    for (const auto& [name, property] : {std::pair{"encoder inputs", property_encoder_inputs},
                                         std::pair{"analog outputs", property_analog_outputs}}) {
      int32_t count = 0;
      const int32_t asked = property;
      const t_error result = ask(call_.hil_get_integer_property, card_, &asked, 1u, &count);
      tell(name, result < 0 ? shown(result) : fmt::format("{}", count));
    }
  }

  void touch() {
    const uint32_t first = 0;
    const double zero = 0, one = 1, low = -10, high = 10;
    tell("output range of ±10 V",
         shown(ask(call_.hil_set_analog_output_ranges, card_, &first, 1u, &low, &high)));
    tell("a write of 0 V", shown(call_.hil_write_analog(card_, &first, 1, &zero)));
    ask_encoder(first);
    tell("termination states", shown(ask(call_.hil_set_analog_termination_state, card_, &first, 1u, &zero)));
    tell("an expiry value of 1 V",
         shown(ask(call_.hil_watchdog_set_analog_expiration_state, card_, &first, 1u, &one)));
    ask_watchdog(first);
    tell("left to do by hand", "command a voltage, end the program, and measure whether the output stays");
  }

  /// A counter that accepts a preset beyond 24 bits has more than 24 bits.
  void ask_encoder(uint32_t first) {
    for (const int32_t preset : {0x7fffff, 0x800000, 0x7fffffff}) {
      int32_t counts = 0;
      t_error result =
          ask(call_.hil_set_encoder_counts, card_, &first, 1u, static_cast<const int32_t*>(&preset));
      if (result >= 0) result = ask(call_.hil_read_encoder, card_, &first, 1u, &counts);
      tell(fmt::format("encoder 0 after a preset of {}", preset),
           result < 0 ? shown(result) : fmt::format("{}", counts));
    }
    const int32_t zero = 0;
    ask(call_.hil_set_encoder_counts, card_, &first, 1u, &zero);
  }

  void ask_watchdog(uint32_t first) {
    std::vector<uint32_t> all;
    const std::vector<double> zeros(size_t(settings_.analog_outputs), 0.0);
    for (int i = 0; i < settings_.analog_outputs; ++i) all.push_back(uint32_t(i));
    tell("expiry values of 0 V on all outputs",
         shown(ask(call_.hil_watchdog_set_analog_expiration_state, card_, channel_list(all.data()),
                   uint32_t(all.size()), volts(zeros.data()))));
    for (const double timeout : {0.001, 0.01, 0.1, 0.4, 0.5, 1.0, 5.0}) {
      tell(fmt::format("watchdog of {:g} s", timeout), shown(ask(call_.hil_watchdog_start, card_, timeout)));
      ask(call_.hil_watchdog_stop, card_), ask(call_.hil_watchdog_clear, card_);
    }
    if (ask(call_.hil_watchdog_start, card_, 0.02) < 0) return;
    pause_s(0.05);
    tell("has expired after its time", shown(ask(call_.hil_watchdog_is_expired, card_)));
    tell("a reload after expiry", shown(ask(call_.hil_watchdog_reload, card_)));
    const double zero = 0;
    tell("a write after expiry", shown(call_.hil_write_analog(card_, &first, 1, &zero)));
    tell("clearing it", shown(ask(call_.hil_watchdog_clear, card_)));
    tell("a write after that", shown(call_.hil_write_analog(card_, &first, 1, &zero)));
  }

  const Settings& settings_;
  const Library& library_;
  const HilFunctions& call_;
  const std::function<bool(const std::string&)>& may_take_over_;
  t_card card_ = nullptr;
  std::vector<ProbeAnswer> answers_;
};

}  // namespace

std::vector<ProbeAnswer> probe(const Settings& settings, bool may_touch,
                               const std::function<bool(const std::string&)>& may_take_over) {
  Library library;
  LibraryProblem problem;
  if (!load_library(settings.library, library, problem))
    return {{"library", fmt::format("{}: {}", problem.message, problem.found), false}};
  return Probe(settings, library, may_take_over).run(may_touch);
}

}  // namespace loopwright::hw::quanser
