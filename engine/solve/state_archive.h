/// Serializes every mutable number of an object: one list of members serves for writing and reading.
#pragma once
#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace loopwright {

class StateArchive {
 public:
  /// For writing.
  StateArchive() = default;
  /// For reading; the bytes must outlive the archive.
  explicit StateArchive(std::string_view bytes) : from_(bytes), reads_(true) {}

  /// Members of plain types without padding.
  template <class... T> void members(T&... member) { (one(member), ...); }

  bool reads() const { return reads_; }
  /// Whether all requested data existed, and no more.
  bool is_whole() const { return good_ && from_.empty(); }
  const std::string& bytes() const { return to_; }

 private:
  template <class T> void one(T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, double>);
    copy(&value, sizeof value);
  }
  /// The length is known on both sides.
  template <class T> void one(std::vector<T>& values) {
    for (T& value : values) one(value);
  }
  template <class T, size_t n> void one(std::array<T, n>& values) {
    for (T& value : values) one(value);
  }
  void copy(void* value, size_t bytes) {
    if (!reads_) return void(to_.append(static_cast<const char*>(value), bytes));
    if (!(good_ = good_ && from_.size() >= bytes)) return;
    std::memcpy(value, from_.data(), bytes);
    from_.remove_prefix(bytes);
  }

  std::string to_;
  std::string_view from_;
  bool reads_ = false, good_ = true;
};

}  // namespace loopwright
