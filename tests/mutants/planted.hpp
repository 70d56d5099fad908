// SPDX-License-Identifier: Apache-2.0
// Functions that planted faults call, see tests/mutants/plant. One build holds many faults; the environment
// variable SIDESTEP_PLANTED chooses the one that is active.
#pragma once

#include <bitset>
#include <chrono>
#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

namespace planted {

inline constexpr int kMaxFaults = 4096;

/// If SIDESTEP_PLANTED_REACHED names a file, the program writes to it the numbers of all faults that it
/// reached.
struct Reached {
  const char* file = std::getenv("SIDESTEP_PLANTED_REACHED");
  std::bitset<kMaxFaults> faults;

  ~Reached() {
    std::FILE* out = file ? std::fopen(file, "w") : nullptr;
    if (!out) return;
    for (int fault = 0; fault < kMaxFaults; ++fault) {
      if (faults[static_cast<std::size_t>(fault)]) std::fprintf(out, "%d\n", fault);
    }
    std::fclose(out);
  }
};
inline Reached reached;

inline const int active = [] {
  const char* text = std::getenv("SIDESTEP_PLANTED");
  return text ? std::atoi(text) : -1;
}();

/// Whether this fault is active.
inline bool on(int fault) {
  if (reached.file) reached.faults[static_cast<std::size_t>(fault)] = true;
  return fault == active;
}

template <typename T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool> && !std::same_as<T, char>;
template <typename T>
concept Duration = requires(T value) {
  typename T::period;
  value.count();
};
template <typename T>
concept Matrix = requires(T value) {
  typename T::PlainObject;
};

/// The left side of a comparison whose boundary a fault shifts, e.g. from < to <=; only for counts and times.
template <typename T>
requires std::integral<std::remove_cvref_t<T>> || Duration<std::remove_cvref_t<T>> || requires(T time) {
  time.time_since_epoch();
}
const T& discrete(const T& value) { return value; }

/// A constant that is a fifth larger or smaller.
template <typename T>
requires Number<T> || Duration<T> T changed(int fault, T value, int sign) {
  if (!on(fault)) return value;
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value == 0 ? sign * 0.1 : value * (1 + sign * 0.2));
  } else if constexpr (Number<T>) {
    const T step = static_cast<T>(value / 5 > 1 ? value / 5 : 1);
    return static_cast<T>(sign > 0 ? value + step : value - step);
  } else {
    const T step =
        value == T{0} ? std::chrono::duration_cast<T>(std::chrono::milliseconds(10)) : T(value / 5);
    return sign > 0 ? value + step : value - step;
  }
}
template <typename T>
T more(int fault, T value) {
  return changed(fault, value, 1);
}
template <typename T>
T less(int fault, T value) {
  return changed(fault, value, -1);
}

/// A term that is dropped.
template <typename T>
requires Number<T> || Duration<T> T drop(int fault, T value) { return on(fault) ? T{} : value; }
template <Matrix T>
typename T::PlainObject drop(int fault, const T& value) {
  typename T::PlainObject result = value;
  if (on(fault)) result.setZero();
  return result;
}
/// A term whose sign is changed.
template <typename T>
requires Number<T> || Duration<T> T flip(int fault, T value) {
  return static_cast<T>(on(fault) ? -value : value);
}
template <Matrix T>
typename T::PlainObject flip(int fault, const T& value) {
  typename T::PlainObject result = value;
  if (on(fault)) result = -result;
  return result;
}
/// A factor that is dropped.
template <Number T>
T one(int fault, T value) {
  return on(fault) ? T{1} : value;
}

}  // namespace planted
