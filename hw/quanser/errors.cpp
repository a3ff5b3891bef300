#include "hw/quanser/errors.h"
#include <algorithm>
#include <cstdlib>
#include <iterator>

namespace loopwright::hw::quanser {
namespace {

struct ErrorName {
  int32_t code;
  std::string_view name;
};
constexpr ErrorName error_names[] = {
#include "hw/quanser/error_names.inc"
};

bool is_one_of(int32_t code, std::initializer_list<int32_t> list) {
  return std::ranges::find(list, code) != list.end();
}
bool is_between(int32_t code, int32_t low, int32_t high) { return code >= low && code <= high; }

}  // namespace

std::string_view error_name(int32_t code) {
  const int32_t positive = std::abs(code);
  const auto found = std::ranges::lower_bound(error_names, positive, {}, &ErrorName::code);
  return found != std::end(error_names) && found->code == positive ? found->name : std::string_view{};
}

bool is_not_supported(int32_t code) {
  const int32_t e = -code;
  return is_between(e, 439, 514) || is_between(e, 591, 599) || is_between(e, 974, 977) ||
         is_one_of(e, {94, 575, 675, 676, 677, 980, 1148, 1188, 1189, 1265});
}

Code classify(int32_t code, bool while_open) {
  const int32_t e = -code;
  if (is_one_of(e, {15, 986, 107, 179})) return Code::no_driver;
  if (is_one_of(e, {1029, 1160, 843}) || (e == 108 && while_open)) return Code::disconnected;
  if (e == 108) return Code::no_driver;
  if (e == 35) return Code::stopped;
  if (is_one_of(e, {109, 1073, 145})) return Code::busy;
  if (is_not_supported(code)) return Code::unsupported;
  if (e == 4 || e == 320 || e == 159 || e == 398 || is_between(e, 121, 142) || is_between(e, 149, 152) ||
      e == 144 || is_between(e, 573, 574) || is_one_of(e, {434, 601, 604, 605, 614}))
    return Code::config_error;
  return Code::device_fault;
}

}  // namespace loopwright::hw::quanser
