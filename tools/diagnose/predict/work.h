/// The work of a search, counted and not timed: where it ends at its limit, it ends there on every machine,
/// and the answer is the same.
#pragma once
#include <fmt/format.h>
#include <cstddef>
#include <limits>
#include <string>

namespace loopwright::diagnosis {

inline std::string told_operations(double count) { return fmt::format("{:.3g}e9 operations", count / 1e9); }

class Work {
 public:
  /// [operations] For a row: a sample of a diagram, a further step of the diagram within that sample, a
  /// sample of an effect, a column through the error filter, a product of two numbers, a block evaluated
  /// once, a load that is followed in flight, its derivative by a parameter, and the gains of a row of their
  /// own. An operation takes about a nanosecond.
  static constexpr double of_a_sample = 250, of_a_step = 60, of_an_effect = 60, of_a_response = 4,
                          of_a_product = 0.25, of_a_block = 4, of_a_flight = 700, of_a_changed_flight = 300,
                          of_gains = 250;

  Work() = default;
  explicit Work(double most) : most_(most) {}
  void add(size_t rows, double operations) { done_ += double(rows) * operations; }
  /// Whether so much of the limit is used up. What is then left out, the answer says.
  bool is_spent(double share) {
    const bool is_spent = done_ > share * most_;
    was_short_ |= is_spent;
    return is_spent;
  }
  /// Of the limit that is used up.
  double share() const { return done_ / most_; }
  bool was_short() const { return was_short_; }
  double done() const { return done_; }

 private:
  double done_ = 0, most_ = std::numeric_limits<double>::infinity();
  bool was_short_ = false;
};

}  // namespace loopwright::diagnosis
