#include "tools/experiment/experiment_shape.h"
#include "engine/record/excerpt.h"
#include "models/signal/between_rows.h"

namespace loopwright {

using namespace shapes;

FileShape driven_port_shape() {
  constexpr auto interpolations = names_of(BetweenRows());
  return object({required("column", text(1), "Name of a column in the data"),
                 optional("unit", text(), "Unit of the numbers, where the data do not state it"),
                 optional("interpolation", choice({interpolations.begin(), interpolations.end()}),
                          "Between rows; hold when left out")});
}

FileShape compared_port_shape() {
  return object({required("column", text(1), "Name of a column in the data"),
                 optional("unit", text(), "Unit of the numbers, where the data do not state it"),
                 optional("resolution", stated(0), "Step of the sensor, in the unit of the column")});
}

FileShape roles_shape() {
  return object({optional("position", text(), "The port with the measured position"),
                 optional("velocity", text(), "The port with the measured velocity"),
                 optional("acceleration", text(), "The port with the measured acceleration"),
                 optional("force", text(), "The sum of forces"),
                 optional("input", text(), "The driven port")});
}

FileShape hold_out_shape() {
  return object({optional("fraction", number(0, 1), "Share of the rows, at the end, that tests the result")});
}

FileShape experiment_shape() {
  return file(
      {optional("title", text()), optional("description", text()),
       required("data", text(1), "The recording: CSV or MAT, relative to this file"),
       optional("time", text(), "Column with the time; found by its name when left out"),
       optional("drive", by_name(driven_port_shape()), "Ports that follow the data"),
       required("compare", by_name(compared_port_shape(), 1), "Ports that are held against the data"),
       optional("roles", roles_shape(), "Which ports are the axis, for a diagnosis"),
       optional("set", by_name(anything()), "Values of this record, as with --set: path → value"),
       optional("sites", list(text()), "Ports where an effect may act, for a diagnosis without roles"),
       optional("hold_out", hold_out_shape(), "Rows that are not fitted, but predicted"),
       optional("rows", choice({"samples", "balances"}),
                "Samples in time, or balances: places where the axis stood still"),
       optional("columns", by_name(Excerpt::column_shape()), "New columns, computed from those of the data"),
       optional("excerpt", Excerpt::rows_shape(), "The rows that are used")});
}

}  // namespace loopwright
