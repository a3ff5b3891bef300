// Damaged files: thousands of mutants of valid diagrams, the same in every run. Each must give a diagram or
// errors.
#include <gtest/gtest.h>
#include <chrono>
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::mutation_test {
namespace {

constexpr std::string_view outer = R"json({
  "loopwright": 1, "title": "Stage µ", "description": "of a test",
  "parameters": {"mass": {"value": 0.25, "unit": "kg"}, "cutoff": {"value": "=2*pi*40", "unit": "rad/s"}, "n": 3,
                 "list": [1, "=n"], "stiffness": "=mass*cutoff^2", "file": "a.csv", "half": "=n > 2 ? 0.5 : sqrt(2)"},
  "solver": {"method": "dopri5", "step": 1e-4, "start": 0, "stop": "=half*4", "relative_tolerance": 1e-8,
             "algebraic_loops": "solve", "seed": 3},
  "inputs": {"force": "N", "load": {"unit": "V/sqrt(Hz)", "description": "x"}},
  "blocks": {
    "source": {"type": "Motion", "file": "=file", "table": [[1, 2], [3, "=list"]], "sample_time": 0.001,
               "sample_offset": {"value": 1, "unit": "ms"}},
    "sum": {"type": "Sum", "signs": "+-", "in": {"terms": ["source.y[2]", "stage.position", "force"]}},
    "stage": {"variants": {"simulated": {"diagram": "inner.json", "parameters": {"payload": "=2*mass", "gain": 2}},
                           "real": {"type": "HardwareIo", "device": "no.json"}},
              "variant": "simulated", "in": {"command": "sum.sum"}},
    "again": {"diagram": "inner.json", "in": {"command": "source.y"}}
  },
  "outputs": {"y": "sum.sum", "z": {"source": "stage.position", "unit": "m"}},
  "log": ["source.y", "stage.*", "stage.mass.velocity"]
})json";

constexpr std::string_view inner = R"({
  "loopwright": 1,
  "parameters": {"payload": {"value": 10, "unit": "g"}, "gain": 1, "total": {"value": "=payload*gain", "unit": "kg"}},
  "inputs": {"command": "N"}, "outputs": {"position": "mass.position"},
  "blocks": {"mass": {"type": "Mass", "mass": "=total", "in": {"force": "command"}}}
})";

class Random {
 public:
  size_t below(size_t n) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<size_t>(state_ >> 33) % n;
  }

 private:
  uint64_t state_ = 20240229;
};

/// Begin and end of every token, approximately as in JSON.
std::vector<std::pair<size_t, size_t>> tokens(std::string_view text) {
  std::vector<std::pair<size_t, size_t>> list;
  for (size_t at = 0; at < text.size();) {
    const size_t begin = at;
    if (text[at] == '"') {
      at = std::min(text.find('"', at + 1), text.size() - 1) + 1;
    } else if (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '-') {
      while (at < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '.' || text[at] == '-'))
        ++at;
    } else {
      ++at;
    }
    if (!std::isspace(static_cast<unsigned char>(text[begin]))) list.emplace_back(begin, at);
  }
  return list;
}

std::string replaced(std::string text, std::pair<size_t, size_t> token, std::string_view by) {
  return text.replace(token.first, token.second - token.first, by);
}

std::string mutant(const std::string& text, Random& random) {
  static const std::string deep(200, '[');
  static const std::string_view spare[] = {"null",
                                           "true",
                                           "1e999",
                                           "-1e308",
                                           "123456789012345678901234567890",
                                           "-0",
                                           "\"\"",
                                           "\"=\"",
                                           "\"=1/0\"",
                                           "\"=stiffness\"",
                                           "\"=mass+cutoff\"",
                                           "\"=((((\"",
                                           "\"=x.y\"",
                                           "{}",
                                           "[]",
                                           "[[[[]]]]",
                                           "{\"value\": 1, \"unit\": \"mm\"}",
                                           "{\"value\": \"=n\", \"unit\": \"?\"}",
                                           "\"\\ud800\"",
                                           "\"\\u0000\"",
                                           "\xff",
                                           "\xc3",
                                           "\"\xed\xa0\x80\"",
                                           "// no",
                                           "/*",
                                           "'",
                                           "\"=list\"",
                                           "\"=file\"",
                                           "\"..\"",
                                           "\"a.b[99999999999999999999]\"",
                                           "\"top.json\"",
                                           "\"/\"",
                                           "\"/dev/null\"",
                                           "1e-400",
                                           "0.1e1",
                                           "\"m^(1/0)\"",
                                           "\"s since 1970-01-01\"",
                                           "9007199254740993",
                                           "{\"type\": \"T\"}",
                                           "{\"diagram\": \"inner.json\"}"};
  const auto all = tokens(text);
  const auto token = all[random.below(all.size())], other = all[random.below(all.size())];
  const std::string other_text = text.substr(other.first, other.second - other.first);
  std::string result = text;
  switch (random.below(10)) {
    case 0:
      result[random.below(text.size())] ^= static_cast<char>(1u << random.below(8));
      return result;
    case 1:
      return text.substr(0, random.below(text.size()));
    case 2:
      return replaced(text, token, other_text);
    case 3:
      return replaced(text, token, "");
    case 4:
      return text.substr(0, token.second) + text.substr(token.first);  // twice
    case 5:
      return replaced(text, token, deep.substr(0, random.below(deep.size())));
    case 6:
      result[random.below(text.size())] = static_cast<char>(random.below(256));
      return result;
    case 7:
      return text.substr(0, std::min(token.first, other.first)) +
             text.substr(std::max(token.second, other.second));
    default:
      return replaced(text, token, spare[random.below(std::size(spare))]);
  }
}

/// Loads a mutant. True if it is still a diagram.
bool load(const DiagramFolder& folder, const std::string& what, const LoadOptions& options = {}) {
  Problems problems;
  const auto begin = std::chrono::steady_clock::now();
  const auto diagram = load_diagram(folder.path("top.json"), options, problems);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(time.count(), 10) << what;
  EXPECT_TRUE(diagram || problems.has_errors()) << what;
  for (const Problem& problem : problems.list()) {
    EXPECT_FALSE(problem.message.empty()) << what;
    EXPECT_TRUE(problem.place.file) << what << to_string(problem);
    EXPECT_LE(problem.place.offset, problem.place.file ? problem.place.file->text.size() : 0)
        << what << to_string(problem);
  }
  EXPECT_EQ(problems.text().empty(), problems.list().empty());
  return !problems.has_errors();
}

TEST(Mutants, OfDiagramsEndInADiagramOrInErrors) {
  DiagramFolder folder;
  folder.with("top.json", outer).with("inner.json", inner);
  ASSERT_TRUE(load(folder, "the original"));
  Random random;
  int good = 0, bad = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string text = mutant(std::string(outer), random);
    for (size_t more = random.below(3); more > 0 && text.size() > 10; --more) text = mutant(text, random);
    folder.with("top.json", text);
    ++(load(folder, text) ? good : bad);
  }
  EXPECT_GT(good, 100);
  EXPECT_GT(bad, 3000);
}

TEST(Mutants, OfSubdiagramsEndInADiagramOrInErrors) {
  DiagramFolder folder;
  folder.with("top.json", outer);
  Random random;
  int good = 0, bad = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = mutant(std::string(inner), random);
    folder.with("inner.json", text);
    ++(load(folder, text) ? good : bad);
  }
  EXPECT_GT(good, 30);
  EXPECT_GT(bad, 1000);
}

TEST(Mutants, OfOptionsEndInADiagramOrInErrors) {
  DiagramFolder folder;
  folder.with("top.json", outer).with("inner.json", inner);
  static const std::string_view heads[] = {"stage.payload",
                                           "source.table.0.1",
                                           "again.mass.mass",
                                           "solver.stop",
                                           "list.0",
                                           "sum.in.terms",
                                           "mass",
                                           "list",
                                           "0",
                                           "1",
                                           "stage",
                                           "solver",
                                           "stop",
                                           "source",
                                           "table",
                                           "payload",
                                           "again",
                                           "",
                                           "x",
                                           "sample_time",
                                           "sum",
                                           "in",
                                           "terms",
                                           "[0]",
                                           "[",
                                           "force",
                                           "command"};
  static const std::string_view values[] = {
      "1", "=n", "=1/0",  "{",    "[1, 2]",         "\"x\"", "3 mm", "nan",       "inf s",
      "",  "=",  "=mass", "true", "{\"value\": 1}", "\xff",  "null", "simulated", "real"};
  Random random;
  const auto path = [&] {
    std::string text(heads[random.below(std::size(heads))]);
    for (size_t more = random.below(2); more > 0; --more)
      text += "." + std::string(heads[random.below(std::size(heads))]);
    return text;
  };
  int good = 0, bad = 0;
  for (int i = 0; i < 3000; ++i) {
    LoadOptions options;
    for (size_t n = 1 + random.below(2); n > 0; --n)
      options.set.emplace_back(path(), values[random.below(std::size(values))]);
    if (random.below(4) == 0) options.variants[path()] = values[random.below(std::size(values))];
    if (random.below(4) == 0) options.drives.push_back({path(), {}});
    std::string what;
    for (const auto& [p, v] : options.set) what += p + "=" + v + " ";
    Problems problems;
    const auto diagram = load_diagram(folder.path("top.json"), options, problems);
    EXPECT_TRUE(diagram || problems.has_errors()) << what;
    EXPECT_EQ(problems.text().empty(), problems.list().empty()) << what;
    ++(problems.has_errors() ? bad : good);
  }
  EXPECT_GT(good, 30);
  EXPECT_GT(bad, 1000);
}

}  // namespace
}  // namespace loopwright::mutation_test
