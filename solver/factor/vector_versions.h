#pragma once
// One build for every processor: a version of a function for each kind of vector, of which the loader takes the best.
// (It asks before a sanitizer has begun, and would end there.)
//   TOPPLE_VECTOR_VERSIONS before a function: the same text for all of them, without eight lanes.
//   TOPPLE_EIGHT_LANES(DECLARATION, STATEMENTS): `Eight` are eight lanes in as many vectors as the processor needs.
//   Where one vector is longer than its registers, the compiler takes it to memory and back number by number, which
//   is several times slower.
#include <type_traits>
#include <utility>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TOPPLE_VECTOR_VERSIONS __attribute__((target_clones("avx512f", "avx2", "default")))
#define TOPPLE_EIGHT_LANES(DECLARATION, ...)               \
  __attribute__((target("avx512f"))) DECLARATION {         \
    using Eight [[maybe_unused]] = EightLanes;             \
    __VA_ARGS__                                            \
  }                                                        \
  __attribute__((target("avx2"))) DECLARATION {            \
    using Eight [[maybe_unused]] = Twice<FourLanes>;       \
    __VA_ARGS__                                            \
  }                                                        \
  __attribute__((target("default"))) DECLARATION {         \
    using Eight [[maybe_unused]] = Twice<Twice<TwoLanes>>; \
    __VA_ARGS__                                            \
  }
#else
#define TOPPLE_VECTOR_VERSIONS
#define TOPPLE_EIGHT_LANES(DECLARATION, ...)   \
  DECLARATION {                                \
    using Eight [[maybe_unused]] = EightLanes; \
    __VA_ARGS__                                \
  }
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

/// To each lane of a sum.
template <class Vector>
[[gnu::always_inline]] inline void add_magnitude(const Vector& of, Vector& sum) {
  sum += of < 0 ? -of : of;
}

/// Twice the lanes of a half, in two vectors.
template <class Half>
struct Twice {
  static constexpr int count = 2 * Half::count;
  /// Copied half by half: as a whole the compiler takes it through memory, in pieces that are not its halves.
  struct [[gnu::may_alias]] Vector {
    using Part = typename Half::Vector;
    Part low{}, high{};
    Vector() = default;
    [[gnu::always_inline]] Vector(const Part& first, const Part& second) : low(first), high(second) {}
    [[gnu::always_inline]] Vector(const Vector& other) : low(other.low), high(other.high) {}
    [[gnu::always_inline]] Vector& operator=(const Vector& other) {
      low = other.low;
      high = other.high;
      return *this;
    }
    [[gnu::always_inline]] Vector& operator+=(const Vector& other) { return *this = *this + other; }
    [[gnu::always_inline]] Vector& operator-=(const Vector& other) { return *this = *this - other; }
    [[gnu::always_inline]] Vector operator-() const { return {-low, -high}; }
    [[gnu::always_inline]] friend Vector operator+(const Vector& a, const Vector& b) {
      return {a.low + b.low, a.high + b.high};
    }
    [[gnu::always_inline]] friend Vector operator-(const Vector& a, const Vector& b) {
      return {a.low - b.low, a.high - b.high};
    }
    [[gnu::always_inline]] friend Vector operator*(const Vector& a, const Vector& b) {
      return {a.low * b.low, a.high * b.high};
    }
    [[gnu::always_inline]] friend Vector operator*(const Vector& a, double b) { return {a.low * b, a.high * b}; }
    [[gnu::always_inline]] friend Vector operator*(double a, const Vector& b) { return b * a; }
    [[gnu::always_inline]] friend void add_magnitude(const Vector& of, Vector& sum) {
      add_magnitude(of.low, sum.low);
      add_magnitude(of.high, sum.high);
    }
  };
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

/// work(k) for k = 0, 1, ... below N, constants each: vectors in an array that only such indices reach stay in
/// registers.
template <int N, class Work>
[[gnu::always_inline]] inline void each_constant(const Work& work) {
  [&]<int... k>(std::integer_sequence<int, k...>) __attribute__((always_inline)) {
    (work(std::integral_constant<int, k>{}), ...);
  }
  (std::make_integer_sequence<int, N>{});
}

/// work(lanes, i) for rows i, i + 1, ... of `rows`, as many at a time as there are lanes: eight while there are so
/// many, then four, two, one.
template <class Eight, class Work>
[[gnu::always_inline]] inline void each_lanes(int rows, const Work& work) {
  int i = 0;
  for (; i + Eight::count <= rows; i += Eight::count) work(Eight{}, i);
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
