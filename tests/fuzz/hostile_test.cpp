// Inputs that no mutation produces: endless, infinitely nested, of the wrong kind, or missing.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include "tests/engine/diagram/diagram_folder.h"
#include "tests/fuzz/pipeline.h"
#include "tests/fuzz/watchdog.h"

namespace loopwright::fuzz::hostile_test {
namespace {

class Hostile : public testing::Test {
 protected:
  ~Hostile() override { unwatch(); }
  /// The result of a diagram with this text.
  Outcome run(const std::string& text) {
    folder_.with("top.json", text);
    return run_file("top.json");
  }
  Outcome run_file(const std::string& name) {
    watch(0, what_);
    return run_diagram(folder_.path(name), what_);
  }
  /// A diagram around these blocks.
  static std::string around(const std::string& blocks,
                            const std::string& solver = R"("method": "rk4", "step": 0.01, "stop": 1)") {
    return fmt::format(R"({{"loopwright": 1, "solver": {{{}}}, "blocks": {{{}}}}})", solver, blocks);
  }
  static std::string repeated(std::string_view text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  }
  DiagramFolder folder_;
  std::string what_ = testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Hostile, DeepNestingIsRefused) {
  for (const char* open : {"[", "{\"a\":", "[[],", "{\"blocks\":["}) {
    EXPECT_EQ(run(repeated(open, 100'000)), Outcome::refused);
    EXPECT_EQ(run("{\"loopwright\": 1, \"blocks\": " + repeated(open, 100'000)), Outcome::refused);
  }
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", \"value\": \"=" + repeated("(", 100'000) + "1" +
                       repeated(")", 100'000) + "\"}")),
            Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", \"value\": \"=" + repeated("-", 100'000) + "1\"}")),
            Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", \"value\": {\"value\": 1, \"unit\": \"" +
                       repeated("(", 100'000) + "m\"}}")),
            Outcome::refused);
  EXPECT_EQ(
      run(around("\"a\": {\"type\": \"Expression\", \"names\": [], \"formula\": \"" + repeated("(", 10'000) +
                 "1" + repeated(")", 9'999) + "\", \"in\": {\"arguments\": []}}")),
      Outcome::refused);
}

TEST_F(Hostile, LongTextsAreRefusedOrServe) {
  const std::string text(5'000'000, 'x');
  EXPECT_EQ(run(text), Outcome::refused);
  EXPECT_EQ(run("\"" + text), Outcome::refused);
  EXPECT_EQ(run(around("\"" + text + "\": {\"type\": \"Constant\", \"value\": 1}")), Outcome::finished);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"" + text + "\"}")), Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", \"value\": \"=" + text + "\"}")), Outcome::refused);
  EXPECT_EQ(
      run(around("\"a\": {\"type\": \"Constant\", \"value\": {\"value\": 1, \"unit\": \"" + text + "\"}}")),
      Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Gain\", \"gain\": 1, \"in\": {\"u\": \"" + text + ".y\"}}")),
            Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"diagram\": \"" + text + "\"}")), Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", \"value\": 1" + std::string(5'000'000, '0') + "}")),
            Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Sum\", \"signs\": \"" + std::string(5'000'000, '+') +
                       "\", \"in\": {\"terms\": []}}")),
            Outcome::refused);
}

TEST_F(Hostile, AHundredThousandMembersTakeNoSquareOfTime) {
  std::string keys, same, wires, blocks;
  for (int i = 0; i < 100'000; ++i) {
    keys += fmt::format("{}\"k{}\": {}", i ? ", " : "", i, i);
    same += fmt::format("{}\"k\": {}", i ? ", " : "", i);
    wires += fmt::format("{}\"c.y\"", i ? ", " : "");
    if (i < 10'000)
      blocks += fmt::format(", \"b{}\": {{\"type\": \"Gain\", \"gain\": 1, \"in\": {{\"u\": \"{}.y\"}}}}", i,
                            i ? fmt::format("b{}", i - 1) : "c");
  }
  const std::string constant = R"("c": {"type": "Constant", "value": 1})";
  EXPECT_EQ(run("{" + keys + "}"), Outcome::refused);
  EXPECT_EQ(run("{" + same + "}"), Outcome::refused);
  EXPECT_EQ(run(around("\"a\": {\"type\": \"Constant\", " + keys + "}")), Outcome::refused);
  EXPECT_EQ(run(around(constant + ", \"s\": {\"type\": \"Sum\", \"signs\": \"+\", \"in\": {\"terms\": [" +
                       wires + "]}}")),
            Outcome::refused);
  EXPECT_EQ(run(around(constant + blocks, R"("method": "euler", "step": 0.5, "stop": 1)")),
            Outcome::finished);
  EXPECT_EQ(run("{\"loopwright\": 1, \"parameters\": {" + keys + "}, \"blocks\": {" + constant +
                "}, \"solver\": {\"stop\": 1}}"),
            Outcome::finished);
}

TEST_F(Hostile, ForeignBytesAreRefused) {
  const std::string good = around(R"("a": {"type": "Constant", "value": 1})");
  EXPECT_EQ(run(good), Outcome::finished);
  EXPECT_EQ(run(""), Outcome::refused);
  EXPECT_EQ(run(" \n\t "), Outcome::refused);
  EXPECT_EQ(run(std::string(1, '\0')), Outcome::refused);
  EXPECT_EQ(run(std::string(100'000, '\0')), Outcome::refused);
  EXPECT_EQ(run(good + std::string(1, '\0')), Outcome::refused);
  EXPECT_EQ(run(std::string(good).replace(good.find("\"a\"") + 1, 1, std::string(1, '\0'))),
            Outcome::refused);
  EXPECT_EQ(run(std::string(good).replace(good.find("\"a\"") + 1, 1, "\xff\xfe")), Outcome::refused);
  EXPECT_EQ(run("\xff\xfe" + good), Outcome::refused);
  std::string utf16;
  for (char c : good) utf16 += {c, '\0'};
  EXPECT_EQ(run(utf16), Outcome::refused);
  std::string all_bytes;
  for (int i = 0; i < 100'000; ++i) all_bytes += char(i * 7919 % 256);
  EXPECT_EQ(run(all_bytes), Outcome::refused);
}

TEST_F(Hostile, FilesThatAreNoneAreRefused) {
  folder_.with("folder.json/inside.json", "{}");
  EXPECT_EQ(run_file("folder.json"), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "folder.json"})")), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "gone.json"})")), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "/dev/zero"})")), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "/proc/self/mem"})")), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "top.json/x"})")), Outcome::refused);
  for (const char* data :
       {"folder.json", "gone.csv", "/dev/zero", "/dev/null", "top.json", ".", "", "\\u0000"})
    EXPECT_EQ(
        run(around(fmt::format(R"("a": {{"type": "RecordedColumn", "file": "{}", "column": "x"}})", data))),
        Outcome::refused)
        << data;
  std::filesystem::create_symlink("loop.json", folder_.path("loop.json"));
  EXPECT_EQ(run(around(R"("a": {"diagram": "loop.json"})")), Outcome::refused);
}

TEST_F(Hostile, AFileThatVanishesBetweenTwoLoadsIsRefused) {
  folder_.with("inner.json", around(R"("a": {"type": "Constant", "value": 1})"));
  EXPECT_EQ(run(around(R"("a": {"diagram": "inner.json"})")), Outcome::finished);
  std::filesystem::remove(folder_.path("inner.json"));
  EXPECT_EQ(run_file("top.json"), Outcome::refused);
  std::filesystem::remove(folder_.path("top.json"));
  Problems problems;
  load_diagram(folder_.path("top.json"), {}, problems);
  EXPECT_TRUE(problems.has_errors());
}

TEST_F(Hostile, DiagramsInsideThemselvesAreRefused) {
  EXPECT_EQ(run(around(R"("a": {"diagram": "top.json"})")), Outcome::refused);
  EXPECT_EQ(run(around(R"("a": {"diagram": "./../" , "in": {}}, "b": {"diagram": "././top.json"})")),
            Outcome::refused);
  folder_.with("other.json", around(R"("a": {"diagram": "top.json"}, "b": {"diagram": "top.json"})"));
  EXPECT_EQ(run(around(R"("a": {"diagram": "other.json"}, "b": {"diagram": "other.json"})")),
            Outcome::refused);
  // No diagram contains itself, but each contains the next one twice: 2^40 blocks.
  for (int i = 0; i < 40; ++i)
    folder_.with(
        fmt::format("d{}.json", i),
        around(fmt::format(R"("a": {{"diagram": "d{0}.json"}}, "b": {{"diagram": "d{0}.json"}})", i + 1)));
  folder_.with("d40.json", around(R"("a": {"type": "Constant", "value": 1})"));
  EXPECT_EQ(run_file("d0.json"), Outcome::refused);
}

TEST_F(Hostile, MemoryWithoutEndIsRefused) {
  const std::string constant = R"("c": {"type": "Constant", "value": 1}, )";
  EXPECT_EQ(run(around(
                constant +
                R"("d": {"type": "Delay", "samples": 2147483647, "sample_time": 0.01, "in": {"u": "c.y"}})")),
            Outcome::refused);
  std::string many = constant;
  for (int i = 0; i < 3; ++i)
    many += fmt::format(
        R"({}"d{}": {{"type": "Delay", "samples": 2000000000, "sample_time": 0.01, "in": {{"u": "c.y"}}}})",
        i ? ", " : "", i);
  EXPECT_EQ(run(around(many)), Outcome::refused);
  EXPECT_EQ(
      run(around(
          constant +
          R"("d": {"type": "MovingAverage", "samples": 2147483647, "sample_time": 0.01, "in": {"u": "c.y"}})")),
      Outcome::refused);
}

}  // namespace
}  // namespace loopwright::fuzz::hostile_test
