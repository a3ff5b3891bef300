// `loopwright recover`: what it makes of a journal, what it says, and its exit code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cstring>
#include "engine/record/csv.h"
#include "engine/record/journal.h"
#include "tests/tools/command/program.h"

namespace loopwright::recover_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Recover : public testing::Test {
 protected:
  /// Four chunks of three rows; begins[i] is the offset of chunk i.
  void SetUp() override {
    JournalWriter journal(path_, {{{"time", "s", {}}}, {}});
    for (int c = 0; c < 4; ++c) {
      begins_.push_back(size_t(std::filesystem::file_size(path_)));
      ASSERT_EQ(journal.append(std::array{3.0 * c, 3.0 * c + 1, 3.0 * c + 2}, 0), 0);
    }
    begins_.push_back(size_t(std::filesystem::file_size(path_)));
    ASSERT_EQ(journal.end({{"rows", "12"}}, 0), 0);
    bytes_ = text_of(path_);
  }
  std::string chunk(size_t i) const { return bytes_.substr(begins_[i], begins_[i + 1] - begins_[i]); }
  std::string head() const { return bytes_.substr(0, begins_[0]); }
  std::string tail() const { return bytes_.substr(begins_[4]); }
  Outcome recover(const std::string& bytes) {
    folder_.with("log.csv.journal", bytes);
    return loopwright_program({"recover", path_, "-o", folder_.path("log.csv")});
  }
  std::vector<double> times() const {
    Problems problems;
    return read_csv(folder_.path("log.csv"), problems).columns.at(0).values;
  }
  DiagramFolder folder_;
  std::string path_ = folder_.path("log.csv.journal"), bytes_;
  std::vector<size_t> begins_;
};

TEST_F(Recover, PartsInAnotherOrderAreUsedInTheirs) {
  const Outcome outcome = recover(head() + chunk(2) + chunk(0) + chunk(3) + chunk(1) + tail());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("12 rows"), HasSubstr("in another order"), Not(HasSubstr("lost"))));
  EXPECT_EQ(times(), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
}

TEST_F(Recover, PartsThatAreThereTwiceAreSaidToRepeat) {
  const Outcome outcome = recover(head() + chunk(0) + chunk(1) + chunk(0) + chunk(2) + chunk(3) + tail());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("repeat rows"), Not(HasSubstr("do not check out"))));
  EXPECT_EQ(times().size(), 12u);
}

TEST_F(Recover, APartThatIsMissingIsAFailureThatIsTold) {
  const Outcome outcome = recover(head() + chunk(3) + chunk(0) + chunk(1) + tail());
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 rows are lost between others"));
  EXPECT_EQ(times(), (std::vector<double>{0, 1, 2, 3, 4, 5, 9, 10, 11}));
}

}  // namespace
}  // namespace loopwright::recover_test
