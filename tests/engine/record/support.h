/// Shared parts of the tests of recordings.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "engine/json/problem.h"
#include "engine/record/recording.h"

namespace loopwright {

/// A temporary folder, removed with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "loopwright_record_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  size_t count_files() const {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void put_bytes(const std::string& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Any finite double: every exponent and every mantissa is equally likely, including denormals and -0.
inline double any_finite(std::mt19937_64& random) {
  while (true) {
    const double number = std::bit_cast<double>(random());
    if (std::isfinite(number)) return number;
  }
}

inline const std::vector<double>& edge_numbers() {
  static const std::vector<double> numbers = {0.0,
                                              -0.0,
                                              5e-324,
                                              -5e-324,
                                              2.2250738585072009e-308,  // the largest denormal
                                              2.2250738585072014e-308,
                                              1.7976931348623157e308,
                                              -1.7976931348623157e308,
                                              0.1,
                                              1.0 / 3.0,
                                              9007199254740993.0,
                                              1e22,
                                              1e23};
  return numbers;
}

/// Equal names, units, facts, and equal bits of every number.
inline void expect_same(const Recording& expected, const Recording& found) {
  EXPECT_EQ(expected.facts, found.facts);
  ASSERT_EQ(expected.columns.size(), found.columns.size());
  for (size_t i = 0; i < expected.columns.size(); ++i) {
    const Column &a = expected.columns[i], &b = found.columns[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.unit, b.unit);
    ASSERT_EQ(a.values.size(), b.values.size());
    for (size_t row = 0; row < a.values.size(); ++row)
      ASSERT_EQ(std::bit_cast<uint64_t>(a.values[row]), std::bit_cast<uint64_t>(b.values[row]))
          << "column " << a.name << ", row " << row << ": " << a.values[row] << " and " << b.values[row];
  }
}

/// Names, units and facts that need quoting and escaping in every layer.
inline Recording awkward_recording() {
  Recording recording;
  const std::vector<double> values = {1, 2, 3};
  for (const char* const name : {"time",
                                 "stage.position",
                                 "motor.force[2]",
                                 "with, comma",
                                 "with; semicolon",
                                 "\"quoted\"",
                                 "half\"quote",
                                 "#hash",
                                 "1.5",
                                 "1,5",
                                 "nan",
                                 "name [with] unit",
                                 "name [m]",
                                 "[m]",
                                 " blank ends ",
                                 "tab\tand\nline\r",
                                 "back\\slash\\n",
                                 "Größe µ 力 🙂",
                                 "\xEF\xBB\xBFmark",
                                 "bad\xFF"
                                 "utf8",
                                 "end",
                                 "a.b",
                                 "a_b",
                                 "a__b",
                                 "_"})
    recording.columns.push_back({name, "", values});
  recording.columns[0].unit = "s";
  recording.columns[1].unit = "m";
  recording.columns[2].unit = "N*s^2/m";
  recording.columns[11].unit = "m";
  recording.columns[13].unit = "a]b[c";
  std::string long_name(100, 'n');  // beyond the 63 characters of MATLAB
  recording.columns.push_back({long_name, " odd\tunit ", values});
  long_name += '2';
  recording.columns.push_back({long_name, "1", values});
  recording.facts = {{"title", "A title: with colon"},
                     {"parameter stage.mass.mass", "0.2621 kg"},
                     {"", ""},
                     {"key: with colon", "two\nlines\r\nand\ttab"},
                     {" blank ", "  both ends  "},
                     {"empty", ""},
                     {"comment", "C:\\new\\table"},
                     {"bytes", std::string("zero \0 and \xC3\x28 bad", 16)},
                     {"same", "1"},
                     {"same", "2"}};
  return recording;
}

}  // namespace loopwright
