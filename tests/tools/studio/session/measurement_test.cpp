// Records as people bring them: units in headings or typed, drives, files that appear, paths outside of the
// folder.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include "tests/tools/studio/session/session_page.h"
#include "tests/tools/studio/session/studio_folder.h"

namespace loopwright::studio::measurement_test {
using testing::HasSubstr;
using testing::Not;

namespace {

/// A mass of 2 kg that a force pushes: x = t²/4 with 1 N.
class Measurements : public testing::Test {
 protected:
  Measurements() {
    folder_.write("parts/axis.json", R"({"loopwright": 1, "inputs": {"force": "N"}, "blocks": {
        "net": {"type": "Sum", "signs": "+", "in": {"terms": ["force"]}},
        "mass": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "net.sum"}}},
      "outputs": {"position": "mass.position", "velocity": "mass.velocity"}})");
    folder_.write("top/stage.json",
                  R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 1},
      "blocks": {
        "push": {"type": "Constant", "value": {"value": 0, "unit": "N"}},
        "axis": {"diagram": "../parts/axis.json", "in": {"force": "push.y"}}},
      "log": ["axis.position"]})");
  }
  /// Time in ms, position in mm with steps of 5 um, force in N.
  void record(const std::string& heading, int reads_every = 1) {
    std::string text = heading + "\n";
    for (int i = 0; i <= 300; ++i) {
      const double x_mm = 0.005 * std::round(200 * 1000 * std::pow(i * 1e-3, 2) / 4);
      text += fmt::format("{},{},1\n", i, i % reads_every == 0 ? fmt::format("{}", x_mm) : "");
    }
    folder_.write("top/log.csv", text);
  }
  Json columns() {
    return page_.ask({{"do", "columns"}, {"path", "top/stage.json"}, {"data", "top/log.csv"}});
  }
  static Json& column(Json& columns, const std::string& name) {
    for (Json& entry : columns["columns"])
      if (entry["column"] == name) return entry;
    ADD_FAILURE() << name << " is not among " << columns["columns"].dump(1);
    return columns["columns"][0];
  }
  static void type_unit(Json& column, const char* unit) {
    column["unit"] = unit, column["unit_is_stated"] = false;
  }
  Json written(const Json& columns) {
    Json roles = Json::object();
    for (const Json& role : columns["roles"]) roles[role["role"].get<std::string>()] = role["port"];
    return page_.ask({{"do", "write_experiment"},
                      {"path", "top/stage.json"},
                      {"experiment", columns["experiment"]},
                      {"data", "top/log.csv"},
                      {"time", columns["time"]},
                      {"columns", columns["columns"]},
                      {"roles", roles},
                      {"replace", true}});
  }
  /// Writes and compares: the model is right.
  void expect_right(const Json& columns) {
    const Json answer = written(columns);
    ASSERT_TRUE(answer["written"]) << answer.dump(1);
    const Json comparison =
        page_.ask({{"do", "compare"}, {"path", "top/stage.json"}, {"experiment", answer["experiment"]}});
    EXPECT_EQ(comparison["drives"], 1);
    ASSERT_EQ(comparison["signals"].size(), 1u);
    EXPECT_LT(comparison["signals"][0]["rmse"].get<double>(), 3e-6) << answer["text"];
    EXPECT_NEAR(comparison["signals"][0]["x"].back().get<double>(), 0.3, 1e-9) << "s";
    EXPECT_NEAR(comparison["signals"][0]["resolution"].get<double>(), 5e-6, 1e-9);
  }

  StudioFolder folder_;
  Page page_{folder_.path() + "/", "top/stage.json"};
};

TEST_F(Measurements, UnitsInParenthesesAreThoseOfTheHeading) {
  record("Time (ms),ActPos (mm),SetForce (N)");
  Json found = columns();
  EXPECT_EQ(column(found, "Time")["unit"], "ms");
  EXPECT_TRUE(column(found, "Time")["unit_is_stated"]);
  EXPECT_NEAR(found["stop"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(column(found, "SetForce")["use"], "drive");
  EXPECT_EQ(column(found, "SetForce")["port"], "axis.force");
  expect_right(found);
}

/// Drawn at its own rows.
TEST_F(Measurements, ASensorMayBeReadLessOften) {
  record("Time (ms),ActPos (mm),SetForce (N)", 3);
  Json found = columns();
  Json& position = column(found, "ActPos");
  position["use"] = "compare", position["port"] = "axis.position", position["resolution"] = "0.005";
  expect_right(found);
  const Json comparison =
      page_.ask({{"do", "compare"}, {"path", "top/stage.json"}, {"experiment", "top/log.experiment.json"}});
  EXPECT_EQ(comparison["signals"][0]["x"].size(), 101u);
  EXPECT_EQ(comparison["signals"][0]["measured"].size(), 101u);
}

/// What this record is known to have is nothing that the page asks for.
TEST_F(Measurements, ValuesOfTheRecordStayAndCount) {
  record("Time (ms),ActPos (mm),SetForce (N)");
  const auto insert = [&](const std::string& file, const std::string& before, const std::string& text) {
    std::string whole = folder_.read(file);
    whole.insert(whole.find(before), text);
    folder_.write(file, whole);
  };
  insert("parts/axis.json", ", \"unit\": \"kg\"", "5");
  const Json found = columns();
  ASSERT_TRUE(written(found)["written"]);
  const std::string set = R"("set": {"axis.mass.mass": "2 kg"})", path = "top/log.experiment.json";
  const auto error = [&] {
    return page_
        .ask({{"do", "compare"}, {"path", "top/stage.json"}, {"experiment", path}})["signals"][0]["rmse"]
        .get<double>();
  };
  EXPECT_GT(error(), 1e-3);
  insert(path, "\"roles\"", set + ", ");
  EXPECT_LT(error(), 3e-6);
  ASSERT_TRUE(written(found)["written"]);
  EXPECT_THAT(folder_.read(path), HasSubstr(set));
  EXPECT_LT(error(), 3e-6);
}

TEST_F(Measurements, UnitsAreTypedForEveryColumnAndTheTime) {
  record("t,x_act,F_mot");
  Json found = columns();
  EXPECT_EQ(column(found, "F_mot")["use"], "drive") << "the only force";
  EXPECT_EQ(column(found, "x_act")["resolution"], "0.005");
  type_unit(column(found, "t"), "ms");
  type_unit(column(found, "x_act"), "mm");
  type_unit(column(found, "F_mot"), "N");
  expect_right(found);
  const std::string text = folder_.read("top/log.experiment.json");
  EXPECT_THAT(text, HasSubstr("\"columns\": {\"t\": {\"unit\": \"ms\"}}"));
  EXPECT_THAT(text, HasSubstr("\"resolution\": 0.005}"));
}

TEST_F(Measurements, UnitsInNamesAreProposedForTheTimeToo) {
  for (const char* time : {"t_ms", "timestamp_millis", "timeMs"}) {
    record(std::string(time) + ",x_mm,F_N");
    Json found = columns();
    EXPECT_EQ(found["time"], time);
    EXPECT_EQ(column(found, time)["unit"], "ms");
    EXPECT_FALSE(column(found, time)["unit_is_stated"]);
    EXPECT_NEAR(found["stop"].get<double>(), 0.3, 1e-12) << "s, as it is shown beside ms";
    expect_right(found);
  }
}

TEST_F(Measurements, TheOnlyColumnInTheUnitOfTheInputDrives) {
  record("t [ms],x_act [mm],F_mot [N]");
  Json found = columns();
  EXPECT_EQ(column(found, "F_mot")["use"], "drive");
  EXPECT_EQ(column(found, "F_mot")["port"], "axis.force");
  expect_right(found);
  record("t [ms],x_act [mm],u [V]");
  found = columns();
  EXPECT_NE(column(found, "u")["use"], "drive") << "volts push nothing";
}

TEST_F(Measurements, AComparisonWithoutDriveIsCounted) {
  record("t [ms],x_act [mm],u [V]");
  Json found = columns();
  const Json answer = written(found);
  ASSERT_TRUE(answer["written"]) << answer.dump(1);
  const Json comparison =
      page_.ask({{"do", "compare"}, {"path", "top/stage.json"}, {"experiment", answer["experiment"]}});
  EXPECT_EQ(comparison["drives"], 0);
}

TEST_F(Measurements, FilesThatAppearAreListed) {
  page_.ask({{"do", "open"}, {"path", "top/stage.json"}});
  folder_.write("top/new.experiment.json",
                R"({"loopwright": 1, "title": "New", "data": "log.csv", "compare": {}})");
  const auto lists_it = [](const Json& files) {
    for (const Json& file : files)
      if (file["path"] == "top/new.experiment.json")
        return file["kind"] == "experiment" && file["title"] == "New";
    return false;
  };
  page_.session().look();
  ASSERT_FALSE(page_.events().empty());
  EXPECT_TRUE(lists_it(page_.events().back()["files"])) << page_.events().back().dump(1);
  std::filesystem::remove(folder_.path("top/new.experiment.json"));
  EXPECT_FALSE(lists_it(page_.ask({{"do", "hello"}})["files"])) << "a reloaded page";
}

TEST_F(Measurements, PathsLeadToTheFilesFromAnywhere) {
  const Json document = page_.ask({{"do", "open"}, {"path", "top/stage.json"}});
  std::map<std::string, std::string> files;
  for (const Json& block : document["view"]["blocks"]) files[block["name"]] = block["file"];
  EXPECT_EQ(files["axis"], "parts/axis.json");
  EXPECT_EQ(page_.ask({{"do", "open"}, {"path", "parts/axis.json"}})["path"], "parts/axis.json");
  const Json run = page_.ask({{"do", "run"}, {"path", "top/stage.json"}});
  EXPECT_EQ(run["command"], "loopwright run " + folder_.path("top/stage.json"))
      << "as in the terminal of the studio";
}

}  // namespace

}  // namespace loopwright::studio::measurement_test
