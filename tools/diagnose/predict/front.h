/// Dry friction changes its side while its signal goes through zero, within a width that a step of the
/// integration jumps over: a front. Steps end before it, and pass it in parts.
#pragma once

namespace loopwright::diagnosis {

class Front {
 public:
  /// In the unit of the signal.
  explicit Front(double width) : width_(width) {}

  /// The signal where a step begins; after half of the length that is tried, along the first slope; and after
  /// half of it, along the second.
  void begins(double signal) { begin_ = signal, curvature_ = 0; }
  void goes(double signal, double length) { slope_ = (signal - begin_) / (length / 2); }
  void bends(double signal, double length) {
    const double half = length / 2;
    curvature_ = (signal - begin_ - slope_ * half) / (half * half);
  }
  /// How far a step may go at most: to where the front begins, or through a part of it.
  double longest_step() const;

 private:
  double width_, begin_ = 0, slope_ = 0, curvature_ = 0;
};

}  // namespace loopwright::diagnosis
