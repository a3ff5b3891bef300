#include "engine/diagram/figures.h"
#include <fmt/format.h>
#include "engine/diagram/wires.h"
#include "engine/json/json.h"

namespace loopwright {
namespace {

constexpr std::string_view shape = R"({"signal": "stage.position", "reference": "reference.position"})";

bool is_number(const Value& value) {
  if (value.kind == Value::Kind::number) return true;
  const Value::Member* number = value.find("value");
  return value.kind == Value::Kind::object && number && number->value.kind == Value::Kind::number;
}

void read_band(const Value& value, const Reader& reader, FigureRequest& request) {
  if (value.kind == Value::Kind::object) {
    reader.reject_unknown(value, {"value", "unit"}, "\"band\"");
    reader.text(value, "unit");
  }
  if (is_number(value))
    request.band = value;
  else
    reader.error(value, "\"band\" is not a number").expected =
        R"(a width in the unit of the signal, as in {"value": 1, "unit": "um"})";
}

}  // namespace

FileShape figure_shape() {
  using namespace shapes;
  return object(
      {required("signal", text(), "A logged signal"),
       required("reference", text(), "The logged signal that it is to follow"),
       optional("band", either({number(), object({required("value", number()), optional("unit", text())})}),
                "Within it the signal has settled; 2 % of the last move when left out")});
}

std::vector<FigureRequest> read_figures(const Value& list, const Reader& reader) {
  std::vector<FigureRequest> requests;
  if (!reader.expect(list, Value::Kind::list, "\"figures\"",
                     "a list of objects: [" + std::string(shape) + "]"))
    return requests;
  for (const Value& item : list.items) {
    if (!reader.expect(item, Value::Kind::object, "an entry of \"figures\"", shape)) continue;
    reject_unknown(reader, item, figure_shape(), "an entry of \"figures\"");
    const Value::Member *signal = item.find("signal"), *reference = item.find("reference");
    if (!signal || !reference) {
      reader.error(item, fmt::format("\"{}\" is missing", signal ? "reference" : "signal")).expected = shape;
      continue;
    }
    FigureRequest request{read_wire(signal->value, "\"signal\"", reader),
                          read_wire(reference->value, "\"reference\"", reader),
                          {}};
    if (const auto* band = item.find("band")) read_band(band->value, reader, request);
    if (!request.signal.source.empty() && !request.reference.source.empty())
      requests.push_back(std::move(request));
  }
  return requests;
}

std::vector<FigureRequest> figures_of(const Diagram& diagram, Problems& problems) {
  const auto file = read_source(diagram.path, {}, problems);
  if (!file) return {};
  const Value root = parse_json(file, problems);
  const Value::Member* list = root.find("figures");
  return list ? read_figures(list->value, Reader{problems, ""}) : std::vector<FigureRequest>();
}

}  // namespace loopwright
