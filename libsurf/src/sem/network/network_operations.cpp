// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/network/network_operations.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sem/network/network_operations.cpp"
#include "core/each_target.h"
#include "sem/network/network_loops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace surf::network::HWY_NAMESPACE {

template <class T, bool sided>
const Operations<T>* all() {
  using L = Loops<T, sided>;
  static constexpr Operations<T> operations{.columns = L::columns,
                                            .facets = L::facets,
                                            .facets_back = L::facets_back,
                                            .facets_change = L::facets_change,
                                            .sky = L::sky,
                                            .sky_back = L::sky_back,
                                            .sky_change = L::sky_change,
                                            .forward = L::forward,
                                            .backward = L::backward,
                                            .change = L::change};
  return &operations;
}
const Operations<float>* in_floats(bool sided) {
  return sided ? all<float, true>() : all<float, false>();
}
const Operations<double>* in_doubles(bool sided) {
  return sided ? all<double, true>() : all<double, false>();
}

}  // namespace surf::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf::network {

HWY_EXPORT(in_floats);
HWY_EXPORT(in_doubles);

template <>
const Operations<float>& operations<float>(bool sided) {
  return *HWY_DYNAMIC_DISPATCH(in_floats)(sided);
}
template <>
const Operations<double>& operations<double>(bool sided) {
  return *HWY_DYNAMIC_DISPATCH(in_doubles)(sided);
}

}  // namespace surf::network
#endif
