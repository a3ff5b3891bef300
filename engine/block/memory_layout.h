/// Determines which words of a block's Memory are numbers, rather than indices or views of buffers. These are
/// the words that a linearization can perturb.
///
/// C++20 cannot list the members of a struct. But a struct can be initialized with a value that converts only
/// to `double` at one position and with values that convert to anything at the others. If this compiles, the
/// member at this position is a number, and the word that holds the value afterwards is its location.
#pragma once
#include <concepts>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace loopwright {
namespace memory_layout {

struct Anything {
  template <class T> constexpr operator T() const { return T{}; }
};
struct One {  // converts only to double
  template <std::same_as<double> T> constexpr operator T() const { return 1.0; }
};

/// The number of initializers that M takes; each element of an array counts.
template <class M, class... Before> constexpr size_t initialisers() {
  if constexpr (requires { M{Before{}..., Anything{}}; })
    return initialisers<M, Before..., Anything>();
  else
    return sizeof...(Before);
}

template <class M, size_t place, size_t... all>
void add_word(std::vector<int>& words, std::index_sequence<all...>) {
  if constexpr (requires { M{std::conditional_t<all == place, One, Anything>{}...}; }) {
    alignas(M) unsigned char bytes[sizeof(M)] = {};
    new (bytes) M{std::conditional_t<all == place, One, Anything>{}...};
    for (size_t at = 0; at + sizeof(double) <= sizeof(M); at += sizeof(double)) {
      double value;
      std::memcpy(&value, bytes + at, sizeof value);
      if (value == 1.0) words.push_back(int(at / sizeof(double)));
    }
  }
}

}  // namespace memory_layout

/// The 8-byte words of M that are numbers. M is a plain struct of numbers, integers, views and arrays of
/// them.
template <class M> std::vector<int> number_words() {
  std::vector<int> words;
  constexpr size_t count = memory_layout::initialisers<M>();
  [&]<size_t... place>(std::index_sequence<place...> all) {
    (memory_layout::add_word<M, place>(words, all), ...);
  }
  (std::make_index_sequence<count>{});
  return words;
}

}  // namespace loopwright
