#include "tools/effects/effect_shape.h"
#include "tools/effects/member_reader.h"
#include "tools/effects/site_effect.h"

namespace loopwright {

using namespace shapes;

namespace {

FileShape count(double low = 0) { return whole(low, most_counted); }
FileShape range() { return list(computed(), 2, 2); }
FileShape not_negative() { return number(0); }

/// The keys that a file or each of its forms has.
std::vector<FileShape::Key> keys_of_form(bool is_complete) {
  const auto key = is_complete ? &required : &optional;
  return {key("physics", text(), "What happens, for people"),
          key("parameters", by_name(either({fitted_parameter_shape(), given_parameter_shape()})), ""),
          key("blocks", by_name(block()),
              "As in a diagram; wires read position, velocity, acceleration, input and force"),
          key("attach", list(either({signal_attachment_shape(), parameter_attachment_shape()}), 1),
              "Where the effect acts"),
          key("needs", needs_shape(), "What a record must contain"),
          optional("equivalents", list(text()), "Other names of effects that look the same"),
          optional("confusable", list(confusable_shape()), "Effects that may look alike"),
          optional("at_rest", choice({"free", "holds", "gives"}), "How it acts on an axis at rest")};
}

FileShape effect_file(bool has_forms) {
  std::vector<FileShape::Key> keys = {required("effect", text(), "Its name, which is also that of its file"),
                                      required("title", text(), "One line for people"),
                                      optional("repeatable", flag(), "It may occur more than once")};
  for (FileShape::Key& key : keys_of_form(!has_forms)) keys.push_back(std::move(key));
  if (has_forms)
    keys.push_back(required("forms", by_name(effect_form_shape(), 1), "Variants: name → what differs"));
  return file(std::move(keys));
}

/// A kind of signal, or a list of kinds.
FileShape signal_kinds() {
  std::vector<std::string_view> kinds(site_kinds().begin(), site_kinds().end());
  kinds.push_back("any");
  const FileShape kind = choice(std::move(kinds));
  return either({kind, list(kind)});
}

/// Kinds of other signals, or "site" alone.
FileShape signals_of_effect() {
  const FileShape site = choice({"site"});
  return either({signal_kinds(), site, list(site, 1, 1)});
}

}  // namespace

FileShape effect_shape() { return either({effect_file(false), effect_file(true)}); }
FileShape effect_form_shape() { return object(keys_of_form(false)); }

FileShape fitted_parameter_shape() {
  return object({required("range", range(), "Lowest and highest value"),
                 required("start", computed(), "A value within the range"),
                 optional("unit", text(), "By role: $position, $force, $input"),
                 optional("description", text()),
                 optional("linear", flag(), "The effect is proportional to it"),
                 optional("period", flag(), "The distance after which the effect repeats"),
                 optional("scale", choice({"linear", "logarithmic", "reciprocal"}), "Spacing of a search"),
                 optional("points", whole(1, 200), "How many values of the range a search tries first")});
}

FileShape given_parameter_shape() {
  return object({required("value", computed(), "Over properties of the record and other parameters"),
                 optional("range", range(), "Which values are plausible"),
                 optional("unit", text(), "By role: $position, $force, $input"),
                 optional("description", text())});
}

FileShape signal_attachment_shape() {
  return object({required("to", choice({"force", "input", "sensor"})),
                 required("from", text(), "block.output"),
                 optional("slope", text(), "Output that states how much `from` would change over a sample"),
                 optional("stage", choice({"command", "amplifier", "iron", "magnets"}),
                          "Where on the way of the input")});
}

FileShape parameter_attachment_shape() {
  return object({required("to", choice({"parameter"})),
                 required("from", text(), "block.output: the equivalent force"),
                 required("parameter", list(text(), 1), "Mass.mass: the first one that the machine has"),
                 required("add", computed(), "What is added to it"),
                 optional("optional", flag(), "A machine without the parameter is left as it is")});
}

FileShape needs_shape() {
  return object(
      {required("text", text(), "For people"), optional("directions", count()), optional("speeds", count()),
       optional("accelerations", count()), optional("reversals", count()), optional("passes", count()),
       optional("periods", not_negative(), "Stroke over the period of the effect"),
       optional("duration_s", not_negative()),
       optional("varied_force", flag(), "The force changes fast, or differs at the same position")});
}

FileShape confusable_shape() {
  return object({required("with", text(), "Another effect"), optional("when", text(), "In which records"),
                 required("experiment", separating_experiment_shape(), "The motion that separates them")});
}

FileShape separating_experiment_shape() {
  return object({required("text", text(), "For people"),
                 optional("speeds", list(number(), 1), "Of the top speed"),
                 optional("distance", not_negative(), "Of the stroke"),
                 optional("acceleration", not_negative(), "Of the top acceleration"),
                 optional("passes", count()), optional("pause_s", not_negative()),
                 optional("added_mass", not_negative(), "Of the mass of the machine"),
                 optional("chirp_amplitude", not_negative(), "Of the level of the force"),
                 optional("chirp_from_hz", not_negative()), optional("chirp_to_hz", not_negative())});
}

FileShape site_effect_shape() {
  return file({required("effect", text(), "Its name, which is also that of its file"),
               required("title", text(), "One line for people"),
               required("physics", text(), "What happens, for people"),
               required("site", signal_kinds(), "Where it may act"),
               required("of", signals_of_effect(), "On which signals it depends; \"site\": its own"),
               optional("parameters", by_name(site_parameter_shape())),
               required("formula", text(), "Of signal and the parameters")});
}

FileShape site_parameter_shape() {
  return object(
      {required("unit", text(), "$site, $site/$signal, $site/$signal^2 or $signal"),
       optional("description", text()), optional("linear", flag(), "The effect is proportional to it"),
       optional("range", range(), "Lowest and highest value, over the sizes of the signal"),
       optional("points", number(1, most_site_points), "How many values of the range a search tries first"),
       optional("scale", choice({"linear", "logarithmic"}), "Spacing of a search")});
}

FileShape any_effect_shape() {
  FileShape any = effect_shape();
  any.parts.push_back(site_effect_shape());
  return any;
}

}  // namespace loopwright
