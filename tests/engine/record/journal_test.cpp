// A log that grows on the disk: intact parts are read, whatever happened to the file.
#include "engine/record/journal.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include "engine/json/problem.h"
#include "engine/record/csv.h"
#include "engine/file/hash.h"
#include "engine/record/mat.h"
#include "tests/engine/diagram/diagram_folder.h"

namespace loopwright::journal_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;

const Recording heading{{{"time", "s", {}}, {"stage.position", "m", {}}, {"größe, [x]", "", {}}},
                        {{"title", "a \"log\"\nof two lines"}, {"plan", "85944171f73967e8"}}};

std::array<double, 3> row_of(int64_t n) { return {1e-3 * double(n), std::sin(double(n)), -double(n)}; }

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void put_bytes(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems flush a file that is overwritten
  std::ofstream(path, std::ios::binary) << bytes;
}

class Journal : public testing::Test {
 protected:
  /// `chunks` chunks of `rows` rows each.
  void write(int chunks, int rows, bool ends = true, int64_t dropped = 0, int headings_every = 1000) {
    std::filesystem::remove(path);
    JournalWriter journal(path, heading);
    for (int c = 0; c < chunks; ++c) {
      std::vector<double> numbers;
      for (int r = 0; r < rows; ++r)
        for (const double x : row_of(c * rows + r)) numbers.push_back(x);
      if (c % headings_every == headings_every - 1) {
        ASSERT_EQ(journal.repeat_heading(), 0);
      }
      ASSERT_EQ(journal.append(numbers, dropped), 0);
    }
    if (ends) {
      ASSERT_EQ(journal.end({{"outputs_safe", "confirmed"}}, dropped), 0);
    }
  }
  /// Every row that the journal yields was written, in order.
  int64_t rows_that_are_right(const JournalReader& journal) {
    int64_t rows = 0;
    double last = -1;
    journal.each_row([&](std::span<const double> row) {
      EXPECT_GT(row[0], last);
      last = row[0];
      const auto n = std::llround(1e3 * row[0]);
      EXPECT_TRUE(std::ranges::equal(row, row_of(n))) << n;
      ++rows;
      return true;
    });
    EXPECT_EQ(rows, journal.survey().rows);
    return rows;
  }
  DiagramFolder folder_;
  std::string path = folder_.path("log.csv.journal");
};

TEST_F(Journal, ComesBackAsItWasWritten) {
  write(7, 11);
  const JournalReader journal(path);
  EXPECT_EQ(rows_that_are_right(journal), 77);
  EXPECT_TRUE(journal.survey().is_whole());
  EXPECT_TRUE(journal.survey().has_end);
  ASSERT_EQ(journal.heading().columns.size(), 3u);
  EXPECT_EQ(journal.heading().columns[2].name, "größe, [x]");
  EXPECT_EQ(journal.heading().columns[1].unit, "m");
  EXPECT_EQ(journal.heading().facts, (Facts{{"title", "a \"log\"\nof two lines"},
                                            {"plan", "85944171f73967e8"},
                                            {"outputs_safe", "confirmed"}}));
}

TEST_F(Journal, CutOffAnywhereItKeepsEveryWholeChunk) {
  write(4, 5);
  const std::string whole = bytes_of(path);
  int64_t most = 0;
  int refused = 0;
  for (size_t size = 0; size < whole.size(); ++size) {
    put_bytes(path, whole.substr(0, size));
    try {
      const JournalReader journal(path);
      const int64_t rows = rows_that_are_right(journal);
      EXPECT_GE(rows, most) << "more bytes, fewer rows";
      most = rows;
      EXPECT_FALSE(journal.survey().has_end);
      EXPECT_EQ(journal.survey().damaged_bytes, 0);
      EXPECT_THAT(journal.heading().facts, Contains(Pair("incomplete", testing::_)));
    } catch (const InputError&) {
      EXPECT_EQ(most, 0) << "only without a heading";
      ++refused;
    }
  }
  EXPECT_EQ(most, 20);
  EXPECT_LT(refused, 250);
}

TEST_F(Journal, AFlippedBitAnywhereCostsOneChunkAndIsTold) {
  write(6, 5, true, 0, 3);
  const std::string whole = bytes_of(path);
  for (size_t at = 8; at < whole.size(); ++at) {
    std::string hurt = whole;
    hurt[at] = char(hurt[at] ^ (1 << at % 8));
    put_bytes(path, hurt);
    const JournalReader journal(path);
    const int64_t rows = rows_that_are_right(journal);
    const JournalSurvey& survey = journal.survey();
    // Damage to the first heading loses the rows up to its repetition. Damage to any other chunk loses this
    // chunk.
    EXPECT_GE(rows, 20) << at;
    EXPECT_EQ(rows + survey.lost_rows, 30) << at;
    EXPECT_FALSE(survey.is_whole()) << at;
  }
}

TEST_F(Journal, RandomDamageNeverGivesAWrongNumber) {
  write(40, 20, true, 0, 7);
  const std::string whole = bytes_of(path);
  std::mt19937 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    std::string hurt = whole;
    for (int i = 0; i < int(random() % 6); ++i) {
      const size_t at = random() % hurt.size(), length = random() % 3000;
      switch (random() % 4) {
        case 0:
          hurt.erase(at, length);
          break;
        case 1:
          hurt.insert(at, hurt.substr(random() % hurt.size(), length));
          break;
        case 2:
          for (size_t k = at; k < std::min(hurt.size(), at + length); ++k) hurt[k] = char(random());
          break;
        default:
          hurt.replace(at, std::min(length, hurt.size() - at), length, '\0');
      }
    }
    put_bytes(path, hurt);
    try {
      const JournalReader journal(path);
      rows_that_are_right(journal);
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr("journal"));
    }
  }
}

/// The chunks of the file after its first bytes.
std::vector<std::string> chunks_of(const std::string& bytes) {
  std::vector<std::string> chunks;
  for (size_t at = 8; at < bytes.size(); at += chunks.back().size()) {
    uint64_t payload = 0;
    std::memcpy(&payload, bytes.data() + at + 8, sizeof payload);
    chunks.push_back(bytes.substr(at, 40 + payload));
  }
  return chunks;
}

TEST_F(Journal, ChunksInAnotherOrderGiveTheirRowsInOrder) {
  write(9, 5, true, 0, 4);
  const std::string whole = bytes_of(path);
  std::vector<std::string> chunks = chunks_of(whole);
  ASSERT_EQ(chunks.size(), 13u) << "nine of rows, three headings, the end";
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::shuffle(chunks.begin(), chunks.end(), random);
    std::string bytes = whole.substr(0, 8);
    for (const std::string& chunk : chunks) bytes += chunk;
    put_bytes(path, bytes);
    const JournalReader journal(path);
    EXPECT_EQ(rows_that_are_right(journal), 45);
    EXPECT_TRUE(journal.survey().is_whole() && journal.survey().has_end);
    EXPECT_TRUE(journal.survey().is_reordered);
    EXPECT_THAT(journal.heading().facts, Contains(Pair("outputs_safe", "confirmed")));
    EXPECT_THAT(journal.heading().facts, Contains(Pair("title", testing::_)));
  }
}

TEST_F(Journal, RowsThatAreThereTwiceAreTakenOnce) {
  write(9, 5);
  const std::string whole = bytes_of(path);
  const std::vector<std::string> chunks = chunks_of(whole);
  put_bytes(path, whole + chunks[3] + chunks[4]);
  const JournalReader journal(path);
  EXPECT_EQ(rows_that_are_right(journal), 45);
  EXPECT_EQ(journal.survey().repeated_bytes, int64_t(chunks[3].size() + chunks[4].size()));
  EXPECT_EQ(journal.survey().damaged_bytes, 0);
  EXPECT_EQ(journal.survey().lost_rows, 0);
}

TEST_F(Journal, OneThatWasCutOffStatesHowManyRowsItHas) {
  write(3, 4, false);
  EXPECT_THAT(JournalReader(path).heading().facts, Contains(Pair("rows", "12")));
  EXPECT_TRUE(is_journal(path.c_str()));
  put_bytes(path, "");
  EXPECT_FALSE(is_journal(path.c_str()));
  std::filesystem::remove(path);
  EXPECT_FALSE(is_journal(path.c_str()));
}

TEST_F(Journal, RowsThatTheDiskDidNotTakeAreTold) {
  write(3, 4, false, 17);
  const JournalReader journal(path);
  EXPECT_EQ(journal.survey().dropped_rows, 17);
  EXPECT_THAT(journal.heading().facts, Contains(Pair("dropped_rows", "17")));
}

TEST_F(Journal, BecomesTheSameCsvAndMatAsARecordingInMemory) {
  write(30, 100);
  const JournalReader journal(path);
  Recording expected = journal.heading();
  for (int64_t n = 0; n < 3000; ++n)
    for (size_t i = 0; i < 3; ++i) expected.columns[i].values.push_back(row_of(n)[i]);
  write_csv(folder_.path("expected.csv"), expected);
  write_mat(folder_.path("expected.mat"), expected);
  EXPECT_TRUE(write_journal_as(folder_.path("log.csv"), journal));
  EXPECT_TRUE(write_journal_as(folder_.path("log.mat"), journal));
  EXPECT_EQ(bytes_of(folder_.path("log.csv")), bytes_of(folder_.path("expected.csv")));
  EXPECT_EQ(bytes_of(folder_.path("log.mat")), bytes_of(folder_.path("expected.mat")));
}

TEST_F(Journal, AnInterruptedConversionLeavesTheTargetAsItWas) {
  write(30, 100);
  const JournalReader journal(path);
  for (const char* name : {"log.csv", "log.mat"}) {
    put_bytes(folder_.path(name), "before");
    EXPECT_FALSE(write_journal_as(folder_.path(name), journal, [] { return true; }));
    EXPECT_EQ(bytes_of(folder_.path(name)), "before");
  }
}

TEST_F(Journal, APictureOfALongLogShowsItsPeaks) {
  std::filesystem::remove(path);
  {
    JournalWriter journal(path, {{{"time", "s", {}}, {"y", "", {}}}, {}});
    std::vector<double> numbers;
    for (int n = 0; n < 10000; ++n)
      numbers.push_back(n), numbers.push_back(n == 1234 ? 9 : n == 8001 ? -7 : 0);
    ASSERT_EQ(journal.append(numbers, 0), 0);
  }
  const Recording picture = read_journal(JournalReader(path), 100);
  EXPECT_LE(picture.rows(), 102u);
  EXPECT_EQ(std::ranges::max(picture.columns[1].values), 9);
  EXPECT_EQ(std::ranges::min(picture.columns[1].values), -7);
  EXPECT_TRUE(std::ranges::is_sorted(picture.columns[0].values));
  EXPECT_EQ(read_journal(JournalReader(path), 10000).rows(), 10000u);
}

TEST_F(Journal, OneThatIsThereIsNeverOverwritten) {
  write(1, 5);
  const std::string before = bytes_of(path);
  EXPECT_THROW(JournalWriter(path, heading), std::runtime_error);
  EXPECT_EQ(bytes_of(path), before);
}

TEST_F(Journal, OtherFilesAreRefused) {
  const std::string other = folder_.path("other");
  const auto message = [&] {
    try {
      JournalReader reader(other);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(), HasSubstr("No such file"));
  put_bytes(other, "time [s],y\n0,1\n");
  EXPECT_THAT(message(), HasSubstr("no journal"));
  put_bytes(other, "LWJRNL1\n");
  EXPECT_THAT(message(), HasSubstr("no heading"));
  std::filesystem::remove(other);
  std::filesystem::create_directory(other);
  EXPECT_THAT(message(), HasSubstr("it is no file"));
  std::filesystem::remove(other);
  ASSERT_EQ(mkfifo(other.c_str(), 0600), 0);
  EXPECT_THAT(message(), HasSubstr("it is no file"));
}

TEST(Crc32c, IsThatOfRfc3720) {
  EXPECT_EQ(crc32c("123456789"), 0xe3069283u);
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8a9136aau);
  EXPECT_EQ(crc32c("6789", crc32c("12345")), 0xe3069283u);
}

}  // namespace
}  // namespace loopwright::journal_test
