#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/record/csv.h"
#include "engine/record/journal.h"
#include "engine/record/recording_file.h"

namespace loopwright {

bool write_journal_as(const std::string& path, const JournalReader& journal,
                      const std::function<bool()>& stops) {
  bool is_stopped = false;
  int64_t row = 0;
  const auto goes_on = [&] { return ++row % 1024 != 0 || !(is_stopped = stops()); };
  if (is_csv_path(path)) {
    CsvWriter csv(path, journal.heading());
    journal.each_row([&](std::span<const double> numbers) { return csv.add(numbers), goes_on(); });
    if (!is_stopped) csv.commit();
    return !is_stopped;
  }
  Recording all = journal.heading();
  for (Column& column : all.columns) column.values.reserve(size_t(journal.survey().rows));
  journal.each_row([&](std::span<const double> numbers) {
    for (size_t i = 0; i < numbers.size(); ++i) all.columns[i].values.push_back(numbers[i]);
    return goes_on();
  });
  if (!is_stopped) write_recording(path, all);
  return !is_stopped;
}

Recording read_journal(const JournalReader& journal, size_t most_rows) {
  Recording recording = journal.heading();
  const auto rows = size_t(journal.survey().rows);
  const size_t bucket = rows <= most_rows ? 1 : 2 * ((rows + most_rows - 1) / std::max<size_t>(most_rows, 1));
  size_t row = 0;
  journal.each_row([&](std::span<const double> numbers) {
    const bool begins = row++ % bucket == 0;
    for (size_t i = 0; i < numbers.size(); ++i) {
      std::vector<double>& values = recording.columns[i].values;
      if (begins) values.insert(values.end(), bucket == 1 ? 1 : 2, numbers[i]);
      if (begins || i == 0) continue;  // the first column is the time
      double& least = values[values.size() - 2];
      double& greatest = values.back();
      least = std::fmin(least, numbers[i]), greatest = std::fmax(greatest, numbers[i]);
    }
    return true;
  });
  return recording;
}

}  // namespace loopwright
