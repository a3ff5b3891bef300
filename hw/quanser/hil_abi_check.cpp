// Compiled only if the vendor's header is installed: checks the table of signatures against the header.
#include <hil.h>
#include <quanser_messages.h>
#include <type_traits>
// In our namespace our types hide the header's types of the same names.
#include "hw/quanser/hil_functions.h"

namespace loopwright::hw::quanser {
namespace {

/// Enumerations become the integers they are passed as, integers of equal width one type, structs void.
template <class T> struct Travels { using type = T; };
template <class T>
requires std::is_enum_v<T>
struct Travels<T> {
  static_assert(sizeof(T) == sizeof(int32_t));
  using type = int32_t;
};
template <class T>
requires(std::is_integral_v<T> && sizeof(T) == 4) struct Travels<T> {
  using type = int32_t;
};
template <class T>
requires std::is_class_v<T>
struct Travels<T> {
  using type = void;
};
template <class T> struct Travels<const T> { using type = const typename Travels<T>::type; };
template <class T> struct Travels<T*> { using type = typename Travels<T>::type*; };
template <class R, class... A> struct Travels<R(A...)> {
  using type = typename Travels<R>::type(typename Travels<A>::type...);
};
template <class R, class... A> struct Travels<R (*)(A...)> : Travels<R(A...)> {};

#define LOOPWRIGHT_HIL_CHECK(name, ...)                                                            \
  static_assert(std::is_same_v<Travels<signatures::name>::type, Travels<decltype(&::name)>::type>, \
                #name " has another signature in the vendor's header");
LOOPWRIGHT_HIL_FUNCTIONS(LOOPWRIGHT_HIL_CHECK, LOOPWRIGHT_HIL_CHECK)
#undef LOOPWRIGHT_HIL_CHECK

static_assert(int(BUFFER_OVERFLOW_MODE_ERROR) == overflow_is_error);
static_assert(int(BUFFER_OVERFLOW_MODE_OVERWRITE) == overflow_drops_oldest);
static_assert(sizeof(::t_version) == sizeof(t_version));

}  // namespace
}  // namespace loopwright::hw::quanser
