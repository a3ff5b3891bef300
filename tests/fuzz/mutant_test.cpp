// Wrong files of every kind, the same in every run: each must give problems that point into a file, or a
// valid result. A mutant that crashes or hangs is named (watchdog.h).
//
//   test_fuzz                                        5,000 mutants
//   LOOPWRIGHT_MUTANTS=1000000 test_fuzz             a million, others than those
#include <gtest/gtest.h>
#include <fmt/format.h>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include "tests/fuzz/kinds.h"
#include "tests/fuzz/watchdog.h"
#include "tests/tools/command/program.h"

namespace loopwright::fuzz::mutant_test {
namespace {

constexpr int parts = 4;  // of each kind, to be divided among processes

long mutants() {
  const char* wanted = std::getenv("LOOPWRIGHT_MUTANTS");
  return wanted ? std::atol(wanted) : 5000;
}

class Mutants : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(Mutants, EndInProblemsOrInResults) {
  const auto [kind_number, part] = GetParam();
  const KindOfFile& kind = kinds_of_files()[size_t(kind_number)];
  const auto file = kind.open();
  const long count = mutants() * kind.share / 100;
  std::map<Outcome, long> outcomes;
  for (long i = part; i < count && !HasFailure(); i += parts) {
    const uint64_t seed = uint64_t(kind_number) * 1'000'000'000 + uint64_t(i);
    Random random(seed);
    const std::string what = fmt::format("==== {}, seed {}\n{}", kind.name, seed, file->make(random));
    watch(seed, what);
    ++outcomes[file->read(what)];
  }
  unwatch();
  const long made = std::max<long>(1, (count - part + parts - 1) / parts);
  // A share p of so few mutants scatters by sqrt(p (1 - p) made): three times that is allowed.
  const auto least = [&](double share) {
    return share * double(made) - 3 * std::sqrt(share * (1 - share) * double(made));
  };
  EXPECT_GE(double(outcomes[Outcome::refused]), least(kind.least_refused)) << kind.name;
  EXPECT_GE(double(outcomes[Outcome::finished]), least(kind.least_accepted)) << kind.name;
}

/// The program itself, on one mutant in a hundred, because each needs a process.
class MutantCommands : public testing::TestWithParam<int> {};

TEST_P(MutantCommands, EndByThemselvesAndNameAPlace) {
  if (access(program().c_str(), X_OK) != 0) GTEST_SKIP() << program() << " is not built";
  const int kind_number = GetParam();
  const KindOfFile& kind = kinds_of_files()[size_t(kind_number)];
  const auto file = kind.open();
  const std::regex place(R"(:\d+:\d+: error: )");
  for (long i = 0; i < std::max(2L, mutants() * kind.share / 10000) && !HasFailure(); ++i) {
    Random random(uint64_t(kind_number) * 1'000'000'000 + 500'000'000 + uint64_t(i));
    const std::string what = file->make(random);
    const std::vector<std::string> arguments = file->command();
    if (arguments.empty()) return;
    const loopwright::Outcome outcome = loopwright_program(arguments);
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 1 || outcome.code == 2 || outcome.code == 130)
        << outcome.code << "\n"
        << outcome.err << "\n"
        << what;
    const bool has_errors = outcome.err.find("error: ") != std::string::npos;
    EXPECT_TRUE(outcome.code != 2 || (has_errors && std::regex_search(outcome.err, place)))
        << outcome.err << "\n"
        << what;
    for (const char c : outcome.out + outcome.err)
      EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << "a control character\n" << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Kind, MutantCommands, testing::Range(0, int(kinds_of_files().size())),
                         [](const auto& test) {
                           return std::string(kinds_of_files()[size_t(test.param)].name);
                         });

INSTANTIATE_TEST_SUITE_P(Files, Mutants,
                         testing::Combine(testing::Range(0, int(kinds_of_files().size())),
                                          testing::Range(0, parts)),
                         [](const auto& test) {
                           return fmt::format("{}_{}", kinds_of_files()[size_t(std::get<0>(test.param))].name,
                                              std::get<1>(test.param));
                         });

}  // namespace
}  // namespace loopwright::fuzz::mutant_test
