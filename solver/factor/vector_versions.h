#pragma once
// TOPPLE_VECTOR_VERSIONS before a function: one build for every processor. The compiler makes a version for each kind
// of vector, the loader takes the best. (It asks before a sanitizer has begun, and would end there.)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TOPPLE_VECTOR_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TOPPLE_VECTOR_VERSIONS
#endif

// TOPPLE_UNROLLED before a loop of known length over vectors that stay in registers: left as a loop, it keeps them in
// memory and goes several times slower.
#if defined(__GNUC__) && !defined(__clang__)
#define TOPPLE_UNROLLED _Pragma("GCC unroll 16")
#else
#define TOPPLE_UNROLLED
#endif

namespace topple::solver {

/// Numbers side by side, wherever they lie in memory.
struct EightLanes {
  static constexpr int count = 8;
  using Vector = double __attribute__((vector_size(8 * sizeof(double)), aligned(sizeof(double)), may_alias));
};
struct FourLanes {
  static constexpr int count = 4;
  using Vector = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));
};
struct TwoLanes {
  static constexpr int count = 2;
  using Vector = double __attribute__((vector_size(2 * sizeof(double)), aligned(sizeof(double)), may_alias));
};
struct OneLane {
  static constexpr int count = 1;
  using Vector = double;
};

#if defined(__clang__)
/// clang forgets in templates that a vector may lie anywhere, and would load it as an aligned one: it is copied
/// instead.
template <class Lanes>
class LanesPlace {
 public:
  using Vector = typename Lanes::Vector;
  explicit LanesPlace(double* p) : p_(p) {}
  operator Vector() const {
    Vector value;
    __builtin_memcpy(&value, p_, sizeof value);
    return value;
  }
  LanesPlace& operator=(const Vector& value) {
    __builtin_memcpy(p_, &value, sizeof value);
    return *this;
  }
  LanesPlace& operator=(const LanesPlace& other) { return *this = Vector(other); }
  LanesPlace& operator+=(const Vector& value) { return *this = Vector(*this) + value; }
  LanesPlace& operator-=(const Vector& value) { return *this = Vector(*this) - value; }
  friend Vector operator-(const LanesPlace& place) { return -Vector(place); }
  template <class Factor>
  friend Vector operator*(const LanesPlace& place, const Factor& factor) {
    return Vector(place) * factor;
  }

 private:
  double* p_;
};
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Vector lanes_at(const double* p) {
  typename Lanes::Vector value;
  __builtin_memcpy(&value, p, sizeof value);
  return value;
}
template <class Lanes>
[[gnu::always_inline]] inline LanesPlace<Lanes> lanes_at(double* p) {
  return LanesPlace<Lanes>(p);
}
#else
template <class Lanes>
[[gnu::always_inline]] inline const typename Lanes::Vector& lanes_at(const double* p) {
  return *reinterpret_cast<const typename Lanes::Vector*>(p);
}
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Vector& lanes_at(double* p) {
  return *reinterpret_cast<typename Lanes::Vector*>(p);
}
#endif

/// work(lanes, i) for rows i, i + 1, ... of `rows`, as many at a time as there are lanes: eight while there are so
/// many, then four, two, one.
template <class Work>
[[gnu::always_inline]] inline void each_lanes(int rows, const Work& work) {
  int i = 0;
  for (; i + EightLanes::count <= rows; i += EightLanes::count) work(EightLanes{}, i);
  if (rows - i >= FourLanes::count) {
    work(FourLanes{}, i);
    i += FourLanes::count;
  }
  if (rows - i >= TwoLanes::count) {
    work(TwoLanes{}, i);
    i += TwoLanes::count;
  }
  if (i < rows) work(OneLane{}, i);
}

}  // namespace topple::solver
