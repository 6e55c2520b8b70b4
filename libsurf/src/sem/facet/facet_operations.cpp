// SPDX-License-Identifier: GPL-3.0-or-later
#include "sem/facet/facet_operations.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sem/facet/facet_operations.cpp"
#include "core/each_target.h"
#include "sem/facet/facet_loops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace surf::facet::HWY_NAMESPACE {

template <class T>
const Operations<T>* all() {
  using L = Loops<T>;
  static constexpr Operations<T> operations{.columns = L::columns,
                                            .across = L::across,
                                            .along = L::along,
                                            .along_transposed = L::along_transposed,
                                            .turn = L::turn,
                                            .across_transposed = L::across_transposed,
                                            .invariants = L::invariants,
                                            .combine = L::combine,
                                            .pull_back = L::pull_back,
                                            .push_forward = L::push_forward,
                                            .angles = L::angles,
                                            .spread = L::spread,
                                            .spread_transposed = L::spread_transposed,
                                            .between_rows = L::between_rows,
                                            .between_rows_transposed = L::between_rows_transposed,
                                            .relative = L::relative,
                                            .largest = L::largest};
  return &operations;
}
const Operations<float>* in_floats() { return all<float>(); }
const Operations<double>* in_doubles() { return all<double>(); }

}  // namespace surf::facet::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace surf::facet {

HWY_EXPORT(in_floats);
HWY_EXPORT(in_doubles);

template <>
const Operations<float>& operations<float>() {
  return *HWY_DYNAMIC_DISPATCH(in_floats)();
}
template <>
const Operations<double>& operations<double>() {
  return *HWY_DYNAMIC_DISPATCH(in_doubles)();
}

}  // namespace surf::facet
#endif
