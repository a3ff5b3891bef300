// Damaged files: reading any damaged CSV file ends with errors or with a well-formed recording.
#include "engine/record/csv.h"
#include "mutation.h"
#include "support.h"

namespace loopwright::csv_mutation_test {
namespace {

std::vector<std::string> valid_files() {
  std::vector<std::string> files = {
      "t_s,q_ref_m,q_meas_m\n0.000,0.00010782208,7.45e-06\n0.001,0.00012172102,1.43e-05\n0.002,0.000135,2.2e-"
      "05\n",
      "\xEF\xBB\xBFtime;\"name; quoted\"\r\n0;1\r\n1;-2.5e-3\r\n2;+3\r\n",
      "# title: a comment\n# t x y\n0 1 2\n1 2 3\n2 3 4",
      "Zeit\tWeg [mm]\n0\t0.5\n1\t0.25\n",
  };
  const TemporaryFolder folder;
  write_csv(folder / "a.csv", awkward_recording());
  files.push_back(bytes_of(folder / "a.csv"));
  return files;
}

TEST(CsvMutation, ReadingEndsWithErrorsOrAWellFormedRecording) {
  const std::vector<std::string> files = valid_files();
  std::mt19937_64 random(5);
  int refused = 0, read = 0;
  for (int i = 0; i < 20'000; ++i) {
    const std::string damaged = mutate(files[random() % files.size()], random);
    Problems problems;
    const bool allows = random() % 2 == 0;
    const ReadOptions options{.allow_not_finite = allows, .allow_holes = allows};
    const auto source = std::make_shared<SourceFile>(SourceFile{"damaged.csv", damaged});
    const Recording recording = parse_csv(source, problems, options);
    ASSERT_TRUE(is_refused_or_well_formed(recording, problems, options)) << damaged;
    ++(problems.has_errors() ? refused : read);
    for (const Problem& problem : problems.list()) ASSERT_LE(problem.place.offset, damaged.size());
    ASSERT_LE(problems.text().size(), 100'000u);
  }
  // Both results occurred often: the test is meaningful.
  EXPECT_GT(refused, 2000);
  EXPECT_GT(read, 2000);
}

TEST(CsvMutation, MemoryStaysInProportionToTheFile) {
  // A wide header over empty lines, and many empty lines: neither may reserve columns times lines.
  std::string wide = "a0";
  for (int i = 1; i < 20'000; ++i) wide += ",a" + std::to_string(i);
  Problems problems;
  const auto source =
      std::make_shared<SourceFile>(SourceFile{"wide.csv", wide + std::string(1'000'000, '\n')});
  EXPECT_TRUE(parse_csv(source, problems).columns.empty());
  EXPECT_TRUE(problems.has_errors());
}

}  // namespace
}  // namespace loopwright::csv_mutation_test
