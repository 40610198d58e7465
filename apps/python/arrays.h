#pragma once
// numpy arrays over memory of the library: read-only, without a copy, alive as long as any of them is.
#include <pybind11/numpy.h>

#include <memory>
#include <span>
#include <vector>

namespace topple::python {

namespace py = pybind11;

using Owner = std::shared_ptr<const void>;
using Shape = std::vector<py::ssize_t>;
using Doubles = py::array_t<double>;
using Integers = py::array_t<std::int32_t>;
using Handles = py::array_t<std::int64_t>;

/// What numpy holds on to, so that `owner` lives as long as the array does.
[[nodiscard]] inline py::capsule held(const Owner& owner) {
  return {new Owner(owner), [](void* held_owner) { delete static_cast<Owner*>(held_owner); }};
}

/// `strides` in bytes; `first` may be null where the shape holds nothing.
template <class T>
[[nodiscard]] py::array_t<T> view_of(const T* first, const Shape& shape, const Shape& strides, const Owner& owner) {
  static const T none{};
  py::array_t<T> array(shape, strides, first != nullptr ? first : &none, held(owner));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A list of fixed-size vectors as rows: shape (items, numbers).
template <class Vector>
[[nodiscard]] Doubles rows_of(const std::vector<Vector>& items, const Owner& owner) {
  constexpr py::ssize_t numbers = Vector::SizeAtCompileTime;
  static_assert(sizeof(Vector) == sizeof(double) * numbers);
  return view_of(items.empty() ? nullptr : items.front().data(), {static_cast<py::ssize_t>(items.size()), numbers},
                 {sizeof(Vector), sizeof(double)}, owner);
}

/// One number of each item of a list of structs: shape (items), or (items, inner...) where `inner` numbers follow it
/// at `inner_strides`.
template <class Item, class T, class Get>
[[nodiscard]] py::array_t<T> field_of(const std::vector<Item>& items, Get get, const Owner& owner, Shape inner = {},
                                      Shape inner_strides = {}) {
  const T* const first = items.empty() ? nullptr : get(items.front());
  inner.insert(inner.begin(), static_cast<py::ssize_t>(items.size()));
  inner_strides.insert(inner_strides.begin(), sizeof(Item));
  return view_of(first, inner, inner_strides, owner);
}

/// A new array with a copy of the numbers.
template <class T, class Range>
[[nodiscard]] py::array_t<T> copied(const Range& range) {
  py::array_t<T> array(static_cast<py::ssize_t>(std::size(range)));
  T* out = array.mutable_data();
  for (const auto& value : range) *out++ = static_cast<T>(value);
  return array;
}

/// A fixed-size vector as a new array.
template <class Vector>
[[nodiscard]] Doubles vector_of(const Vector& vector) {
  Doubles array(static_cast<py::ssize_t>(vector.size()));
  for (int i = 0; i < static_cast<int>(vector.size()); ++i)
    array.mutable_data()[i] = vector[static_cast<decltype(vector.size())>(i)];
  return array;
}

/// Indices into an array of the building.
template <class Id>
[[nodiscard]] Integers indices_of(const std::vector<Id>& ids) {
  Integers array(static_cast<py::ssize_t>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i) array.mutable_data()[i] = ids[i].index;
  return array;
}

}  // namespace topple::python
