/// Device files for tests: that of the QPIDe with changes.
#pragma once
#include <fstream>
#include <nlohmann/json.hpp>
#include "hw/drivers.h"
#include "tests/engine/diagram/diagram_folder.h"
#include "where.h"

namespace loopwright::hw {

/// hw/devices/qpid_e.json with a JSON merge patch: null removes a member.
inline std::string device_text(const std::string& patch = "{}") {
  nlohmann::ordered_json device =
      nlohmann::ordered_json::parse(std::ifstream(LOOPWRIGHT_SOURCE "/hw/devices/qpid_e.json"));
  device.merge_patch(nlohmann::ordered_json::parse(patch));
  return device.dump(2);
}

/// Every problem of a device file, with relative file names.
inline std::string problems_of_device(const std::string& text) {
  DiagramFolder folder;
  folder.with("device.json", text);
  Problems problems;
  load_device(folder.path("device.json"), {}, problems);
  std::string all = problems.text();
  for (size_t at; (at = all.find(folder.path(""))) != all.npos;) all.erase(at, folder.path("").size());
  return all;
}

/// The description. Fails the test if it has problems.
inline std::shared_ptr<const DeviceDescription> device_of(const std::string& patch = "{}") {
  DiagramFolder folder;
  folder.with("device.json", device_text(patch));
  Problems problems;
  auto device = load_device(folder.path("device.json"), {}, problems);
  EXPECT_EQ(problems.text(), "");
  return device;
}

}  // namespace loopwright::hw
