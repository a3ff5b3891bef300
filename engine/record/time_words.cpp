#include "engine/record/time_words.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace loopwright {
namespace {

struct Word {
  std::string_view word, unit;
};
/// Wherever they stand in the name.
constexpr Word anywhere[] = {
    {"ms", "ms"},      {"msec", "ms"},   {"msecs", "ms"},  {"milli", "ms"},        {"millis", "ms"},
    {"us", "us"},      {"usec", "us"},   {"usecs", "us"},  {"micro", "us"},        {"micros", "us"},
    {"µs", "us"},      {"μs", "us"},     {"ns", "ns"},     {"nsec", "ns"},         {"nsecs", "ns"},
    {"nano", "ns"},    {"nanos", "ns"},  {"mins", "min"},  {"minutes", "min"},     {"hours", "h"},
    {"hrs", "h"},      {"days", "day"},  {"tms", "ms"},    {"tus", "us"},          {"milliseconds", "ms"},
    {"millisecond", "ms"}, {"microseconds", "us"}, {"microsecond", "us"}, {"nanoseconds", "ns"},
    {"nanosecond", "ns"}};
/// At the end of a name of several words: "min_time" is a minimum, "h" a height.
constexpr Word at_end[] = {{"min", "min"}, {"minute", "min"}, {"h", "h"}, {"hr", "h"}, {"hour", "h"}, {"day", "day"}};
/// At the end of a name: "sample_time" is a time.
constexpr std::string_view counts[] = {"tick",  "ticks",  "sample",  "samples", "frame", "frames",
                                       "count", "counts", "counter", "cycles",  "index", "idx"};

/// "timestamp_millis" → timestamp, millis. "timeUs" → time, us. "Timems" → ms.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_letter = std::isalpha(c) || c >= 0x80;
    const bool begins = std::isupper(c) && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1]));
    if (!is_letter || begins) words.emplace_back();
    if (is_letter) words.back() += c < 0x80 ? char(std::tolower(c)) : name[i];
  }
  std::erase(words, "");
  for (std::string& word : words)
    for (const std::string_view time : {"timestamp", "time"})
      if (word.starts_with(time) && word.size() > time.size()) word.erase(0, time.size());
  return words;
}

}  // namespace

TimeWords time_words(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  for (const std::string& word : words)
    if (const auto found = std::ranges::find(anywhere, word, &Word::word); found != std::end(anywhere))
      return {std::string(found->unit), false};
  if (words.size() > 1)
    if (const auto found = std::ranges::find(at_end, words.back(), &Word::word); found != std::end(at_end))
      return {std::string(found->unit), false};
  return {"", !words.empty() && std::ranges::find(counts, words.back()) != std::end(counts)};
}

}  // namespace loopwright
