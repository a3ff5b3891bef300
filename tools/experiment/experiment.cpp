#include "tools/experiment/experiment.h"
#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <numeric>
#include "engine/json/file_kind.h"
#include "engine/json/json.h"
#include "engine/json/nearest_file.h"
#include "engine/json/reader.h"
#include "engine/json/stated_number.h"
#include "engine/record/column_units.h"
#include "engine/record/excerpt.h"
#include "engine/record/recording_file.h"
#include "hw/realtime/deploy.h"
#include "tools/experiment/balances.h"
#include "tools/experiment/data_file.h"
#include "tools/experiment/impossible_values.h"
#include "tools/experiment/experiment_shape.h"
#include "tools/experiment/signal_figures.h"

namespace loopwright {
namespace {

class Loader {
 public:
  Loader(std::string path, Problems& problems) : reader_{problems, ""}, problems_(problems) {
    result_->path = std::move(path);
  }

  std::shared_ptr<const Experiment> run() {
    const auto source = read_source(result_->path, {}, problems_);
    if (!source) return nullptr;
    const Value file = parse_json(source, problems_);
    if (problems_.has_errors() ||
        !reader_.expect(file, Value::Kind::object, "an experiment", "an object in braces") ||
        !expect_kind(file, FileKind::experiment, problems_))
      return nullptr;
    reject_unknown(reader_, file, experiment_shape(), "an experiment");
    reader_.check_version(file);
    result_->title = reader_.text(file, "title"), result_->place = file.place;
    read_signals(file, "drive", result_->drives);
    read_signals(file, "compare", result_->compared);
    read_roles(file);
    read_set(file);
    read_sites(file);
    read_hold_out(file);
    read_kind_of_rows(file);
    excerpt_ = Excerpt::read(file, reader_);
    read_data(file);
    if (!problems_.has_errors() && result_->is_map) gather_balances(*result_, problems_);
    return result_;
  }

 private:
  void read_signals(const Value& file, std::string_view key, std::vector<RecordedSignal>& to) {
    const Value::Member* list = file.find(key);
    if (!list) {
      if (key == "compare")
        reader_.error(file, "the experiment compares nothing").expected =
            "\"compare\": {\"axis.position\": {\"column\": …, \"unit\": …}}";
      return;
    }
    if (!reader_.expect(list->value, Value::Kind::object, fmt::format("\"{}\"", key),
                        "an object: port → column and unit"))
      return;
    for (const Value::Member& entry : list->value.members) {
      if (!reader_.expect(entry.value, Value::Kind::object, entry.name, "{\"column\": …, \"unit\": …}"))
        continue;
      const bool drives = key == "drive";
      if (drives)
        reject_unknown(reader_, entry.value, driven_port_shape(), "a driven port");
      else
        reject_unknown(reader_, entry.value, compared_port_shape(), "a compared port");
      RecordedSignal signal;
      signal.port = entry.name, signal.place = entry.place, signal.pointer = entry.value.place.pointer();
      signal.column = reader_.text(entry.value, "column");
      signal.unit = reader_.text(entry.value, "unit");
      if (signal.column.empty())
        reader_.error(entry, fmt::format("\"{}\" names no column", entry.name)).expected =
            "\"column\": name of a column in the data";
      if (drives)
        signal.between_rows = interpolation(entry.value);
      else
        read_resolution(entry);
      to.push_back(std::move(signal));
    }
    if (list->value.members.empty() && key == "compare")
      reader_.error(*list, "the experiment compares nothing");
  }
  /// Its unit is compared with that of the column once the data are known.
  void read_resolution(const Value::Member& compared) {
    if (const Value::Member* member = compared.value.find("resolution"))
      if (auto stated = stated_number(member->value, "\"resolution\"", reader_, 0))
        resolutions_[compared.name] = std::move(*stated);
  }
  BetweenRows interpolation(const Value& entry) {
    constexpr auto names = names_of(BetweenRows());
    const Value::Member* member = entry.find("interpolation");
    if (!member) return BetweenRows::hold;
    const std::string text = reader_.text(entry, "interpolation");
    const auto found = std::ranges::find(names, text);
    if (found != names.end()) return BetweenRows(found - names.begin());
    auto& p = reader_.error(*member, "there is no such interpolation");
    p.expected = fmt::format("one of \"{}\"", fmt::join(names, "\", \""));
    if (const std::string near = nearest_name(text, {names.begin(), names.end()}); !near.empty())
      p.hint = fmt::format("did you mean \"{}\"?", near);
    return BetweenRows::hold;
  }

  void read_roles(const Value& file) {
    const Value::Member* roles = file.find("roles");
    if (!roles || !reader_.expect(roles->value, Value::Kind::object, "\"roles\"", "an object: role → port"))
      return;
    reject_unknown(reader_, roles->value, roles_shape(), "the roles");
    for (const Value::Member& role : roles->value.members) {
      result_->roles.ports.emplace_back(role.name, reader_.text(roles->value, role.name));
      result_->roles.places.push_back(role.place);
    }
  }
  /// What stands there is checked when a diagram is read with it.
  void read_set(const Value& file) {
    const Value::Member* set = file.find("set");
    if (!set || !reader_.expect(set->value, Value::Kind::object, "\"set\"",
                                R"(an object: path → value, {"payload": {"value": 0.5, "unit": "kg"}})"))
      return;
    result_->set = set->value.members;
    for (const Value::Member& setting : result_->set) {
      if (split_path(setting.name).front() != "solver") continue;
      auto& p = reader_.error(setting, "a record has no solver of its own");
      p.expected = "parameters of the diagram that have another value in this record";
      p.hint = "--set solver.… holds for all records";
    }
  }
  void read_sites(const Value& file) {
    const Value::Member* sites = file.find("sites");
    if (!sites || !reader_.expect(sites->value, Value::Kind::list, "\"sites\"", "a list of ports")) return;
    for (const Value& site : sites->value.items)
      if (reader_.expect(site, Value::Kind::text, "a site", "a port, \"axis.net_force.sum\""))
        result_->sites.push_back({site.text, site.place});
    if (result_->roles.ports.empty()) return;
    auto& p = reader_.error(*sites, "the sites of an axis follow from its roles");
    p.expected = "\"roles\" or \"sites\"";
  }
  void read_hold_out(const Value& file) {
    const Value::Member* hold_out = file.find("hold_out");
    if (!hold_out ||
        !reader_.expect(hold_out->value, Value::Kind::object, "\"hold_out\"", "{\"fraction\": 0.3}"))
      return;
    reject_unknown(reader_, hold_out->value, hold_out_shape(), "\"hold_out\"");
    result_->hold_out_fraction = reader_.optional_number(hold_out->value, "fraction", 0, 0, 1);
  }

  void read_kind_of_rows(const Value& file) {
    const Value::Member* rows = file.find("rows");
    if (!rows) return;
    const std::string text = reader_.text(file, "rows");
    result_->is_map = text == "balances", result_->map_place = rows->place;
    if (text == "balances" || text == "samples") return;
    reader_.error(*rows, "rows of such a kind are not known").expected =
        "\"samples\" in time, or \"balances\": places where the axis stood still";
  }

  void read_data(const Value& file) {
    const std::string name = reader_.text(file, "data");
    const Value::Member* member = file.find("data");
    if (name.empty()) {
      reader_.error(file, "the experiment names no data").expected = "\"data\": \"measured.csv\"";
      return;
    }
    result_->data_path = find_data_file(result_->path, name, [&](std::string message) -> Problem& {
      return reader_.error(*member, std::move(message));
    });
    if (result_->data_path.empty()) return;
    const size_t before = problems_.list().size();
    Recording data = read_recording(result_->data_path, problems_, {.allow_holes = true});
    if (data.columns.empty() || has_errors_from(before)) return;
    excerpt_.apply(data, reader_.text(file, "time"), reader_);
    if (has_errors_from(before)) return;
    leave_out_repeats(file, data, *member);
    read_time(file, data, *member);
    for (auto* list : {&result_->drives, &result_->compared})
      for (RecordedSignal& signal : *list) {
        const bool may_be_slower = list == &result_->compared && !result_->is_map;
        if (may_be_slower || !is_refused_as_slower(data, signal)) add_column(data, signal);
      }
  }
  /// A row that a logger wrote twice, with the same time and the same numbers, is read once.
  void leave_out_repeats(const Value& file, Recording& data, const Value::Member& names_data) {
    const Value::Member* named = file.find("time");
    Problems own;  // reported when the columns are read
    const auto error = [&](std::string message) -> Problem& {
      return own.error({}, "", "", std::move(message));
    };
    const auto time = time_in_seconds(data, named ? reader_.text(file, "time") : "", error);
    if (!time || result_->is_map) return;
    std::vector<const Column*> read;
    for (const auto* list : {&result_->drives, &result_->compared})
      for (const RecordedSignal& signal : *list)
        if (const Column* column = find_column(data, signal.column, error)) read.push_back(column);
    std::vector<char> repeats(time->values.size());
    size_t count = 0;
    for (size_t row = 1; row < repeats.size(); ++row) {
      repeats[row] =
          time->values[row] == time->values[row - 1] && std::ranges::all_of(read, [&](const Column* column) {
            return column->values[row] == column->values[row - 1];
          });
      count += size_t(repeats[row]);
    }
    if (count == 0) return;
    for (Column& column : data.columns) {
      size_t row = 0;
      std::erase_if(column.values, [&](double) { return repeats[row++] != 0; });
    }
    problems_.warning(names_data.place, "/data", "",
                      fmt::format("{} row{} the same time and numbers as the row before: {} read once", count,
                                  count == 1 ? " has" : "s have", count == 1 ? "it is" : "they are"));
  }
  bool has_errors_from(size_t begin) const {
    const auto& list = problems_.list();
    return std::any_of(list.begin() + ptrdiff_t(begin), list.end(),
                       [](const Problem& p) { return p.severity == Problem::Severity::error; });
  }
  void read_time(const Value& file, const Recording& data, const Value::Member& names_data) {
    const Value::Member* named = file.find("time");
    if (result_->is_map && !named) {  // the times of its rows have no meaning
      result_->data.columns.push_back({"time", "s", std::vector<double>(data.rows())});
      return;
    }
    const Place& place = named ? named->place : names_data.place;
    const auto time = time_in_seconds(data, named ? reader_.text(file, "time") : "",
                                      error_at(place, named ? "/time" : "/data"));
    if (!time) return;
    result_->time_column = time->name;
    if (!result_->is_map) {
      result_->time = check_time(*time, problems_, {}, names_data.place);
      check_ends(*time, names_data);
      check_lost(data, place);
    }
    // Compared and driven where the samples were taken, not where a coarse clock put them: RecordedColumn,
    // too.
    std::vector<double> instants = unrounded(time->values, result_->time);
    result_->data.columns.push_back({"time", "s", instants.empty() ? time->values : std::move(instants)});
  }
  /// A log counts the samples that its device lost: its times must be consistent with that.
  void check_lost(const Recording& data, const Place& place) {
    const Column* lost = data.find(hw::lost_column);
    if (!lost || lost->values.empty() || !is_without_holes(*lost, error_at(place, "/data"))) return;
    const double counted = std::accumulate(lost->values.begin() + 1, lost->values.end(), 0.0);
    if (!(counted > double(result_->time.missing))) return;
    auto& p = problems_.error(place, "/data", "",
                              fmt::format("the log counts {:.0f} lost samples, and its times leave out {}",
                                          counted, result_->time.missing));
    p.expected = "the times of the device";
    p.found = lost->origin;
    p.hint = "its rows are not as far apart as it says: record it anew";
  }
  ColumnError error_at(const Place& place, const std::string& pointer) {
    return [this, place, pointer](std::string message) -> Problem& {
      return problems_.error(place, pointer, "", std::move(message));
    };
  }
  void check_ends(const Column& time, const Value::Member& member) {
    if (time.values.size() == 1) reader_.error(member, "one row: a record of a motion has two or more");
    if (time.values.empty() || time.values.front() >= 0) return;
    auto& p = reader_.error(member, "the recorded times begin before zero");
    p.found = fmt::format("{} s", time.values.front()), p.hint = "shift them so that they begin at zero";
  }
  void add_column(const Recording& data, RecordedSignal& signal) {
    if (signal.column.empty()) return;  // already reported
    const Column* found = data.find(signal.column);
    if (found) signal.rows = rows_of(*found);
    if (signal.rows.are_all())
      found = find_column(data, signal.column, error_at(signal.place, signal.pointer));
    if (!found) return;
    const auto unit = unit_of(*found, signal.unit, error_at(signal.place, signal.pointer));
    if (!unit) return;
    if (!found->unit.empty()) signal.unit = found->unit;
    signal.resolution = resolution_of(signal.port, *unit);
    Column values = in_si(*found, *unit);
    values.name = signal.port;
    if (!result_->data.find(signal.port)) result_->data.columns.push_back(std::move(values));
  }

  /// What drives has a value at all times, and every balance of a map its numbers.
  bool is_refused_as_slower(const Recording& data, const RecordedSignal& signal) {
    const Column* column = data.find(signal.column);
    const auto [first, every] = column ? rows_of(*column) : SlowerRows{};
    if (every == 1) return false;
    auto& p = problems_.error(signal.place, signal.pointer, "",
                              fmt::format("column \"{}\" has a number in one of {} rows, from row {} on",
                                          signal.column, every, first + 1));
    p.expected = "a number in every row that is used; what is compared may have a slower rate";
    p.found = column->origin;
    p.hint = fmt::format(
        "leave it out, or use the rows that have it: \"excerpt\": {{\"skip\": {}, \"decimate\": {}}}; inputs "
        "are then held from one of these rows to the next",
        first, every);
    return true;
  }

  /// [SI], 0 if it is not stated.
  double resolution_of(const std::string& port, const Unit& of_column) const {
    const auto stated = resolutions_.find(port);
    if (stated == resolutions_.end()) return 0;
    return in_unit(stated->second, of_column, "\"resolution\"", reader_, true).value_or(0) * of_column.scale;
  }

  std::map<std::string, StatedNumber> resolutions_;  // by port
  Excerpt excerpt_;
  std::shared_ptr<Experiment> result_ = std::make_shared<Experiment>();
  Reader reader_;
  Problems& problems_;
};

Value text_value(std::string text) {
  Value value;
  value.kind = Value::Kind::text;
  value.text = std::move(text);
  return value;
}

/// Whether the played columns, too, are computed, or are a part of the record.
bool has_excerpt(const Experiment& experiment) {
  if (!experiment.place.file) return false;  // not from a file
  Problems reported_before;
  const Reader reader{reported_before, ""};
  return !Excerpt::read(parse_json(experiment.place.file, reported_before), reader).empty();
}

}  // namespace

std::shared_ptr<const Experiment> read_experiment(const std::string& path, Problems& problems) {
  Problems own;
  const auto experiment = Loader(path, own).run();
  if (experiment) reject_impossible_values(*experiment, own);
  for (const Problem& problem : own.list()) problems.add(problem);
  return experiment;
}

std::shared_ptr<const Experiment> load_experiment(const std::string& path, Problems& problems) {
  Problems own;
  const auto experiment = read_experiment(path, own);
  for (const Problem& problem : own.list()) problems.add(problem);
  return own.has_errors() ? nullptr : experiment;
}

std::vector<std::shared_ptr<const Experiment>> load_experiments(const std::vector<std::string>& paths,
                                                                Problems& problems) {
  std::vector<std::shared_ptr<const Experiment>> list;
  for (const std::string& path : paths) list.push_back(load_experiment(path, problems));
  return list;
}

LoadOptions with_own_values(const Experiment& experiment, LoadOptions options) {
  std::ranges::copy(experiment.set, std::back_inserter(options.set_in_file));
  return options;
}

LoadOptions follow(const Experiment& experiment, LoadOptions options) {
  options = with_own_values(experiment, std::move(options));
  const bool is_excerpt = has_excerpt(experiment);
  for (const RecordedSignal& signal : experiment.drives) {
    Drive drive;
    drive.port = signal.port;
    drive.settings.kind = Value::Kind::object;
    const auto add = [&](std::string name, std::string text) {
      drive.settings.members.push_back({std::move(name), signal.place, text_value(std::move(text))});
    };
    if (experiment.is_map) {  // the quantities in balance are set row by row
      drive.type = "ExternalSignal", drive.output = "y";
      drive.settings.place = signal.place;
      options.drives.push_back(std::move(drive));
      continue;
    }
    add("file", experiment.data_path);
    add("column", signal.column);
    add("time", experiment.time_column);
    add("unit", signal.unit);
    if (is_excerpt) add("experiment", experiment.path);
    add("interpolation", std::string(names_of(BetweenRows())[size_t(signal.between_rows)]));
    drive.settings.place = signal.place;
    options.drives.push_back(std::move(drive));
  }
  const std::vector<double>& time = experiment.data.columns.front().values;
  const auto set = [&](std::string key, double value) {
    options.set.insert(options.set.begin(), {std::move(key), fmt::format("{} s", value)});
  };
  set("solver.start", time.front());
  set("solver.stop", time.back());
  if (experiment.time.on_grid) set("solver.record_step", experiment.time.sample_time);
  return options;
}

}  // namespace loopwright
