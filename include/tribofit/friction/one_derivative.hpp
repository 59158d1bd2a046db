#pragma once

#include <type_traits>

namespace tribofit::detail {

/// A number with its derivative by one quantity, for what depends on no other parameter: the age of contacts on the
/// distance over which they are renewed, speeds within a contact on that of its rim. To carry the derivatives by all
/// parameters through each sample would cost several times as much.
struct OneDerivative {
  double a = 0, v = 0;

  OneDerivative() = default;
  explicit OneDerivative(double value, double slope = 0) : a(value), v(slope) {}

  friend OneDerivative operator+(OneDerivative x, OneDerivative y) { return OneDerivative(x.a + y.a, x.v + y.v); }
  friend OneDerivative operator-(OneDerivative x, OneDerivative y) { return OneDerivative(x.a - y.a, x.v - y.v); }
  friend OneDerivative operator*(OneDerivative x, OneDerivative y) {
    return OneDerivative(x.a * y.a, x.a * y.v + x.v * y.a);
  }
  friend OneDerivative operator/(OneDerivative x, OneDerivative y) {
    const double inverse = 1 / y.a, ratio = x.a * inverse;
    return OneDerivative(ratio, (x.v - ratio * y.v) * inverse);
  }
  friend OneDerivative operator+(double s, OneDerivative x) { return OneDerivative(s + x.a, x.v); }
  friend OneDerivative operator-(double s, OneDerivative x) { return OneDerivative(s - x.a, -x.v); }
  friend OneDerivative operator-(OneDerivative x, double s) { return OneDerivative(x.a - s, x.v); }
  friend OneDerivative operator*(double s, OneDerivative x) { return OneDerivative(s * x.a, s * x.v); }
  friend OneDerivative operator/(double s, OneDerivative x) { return OneDerivative(s) / x; }
};

/// What such a number is where parameters are of the type T: of plain numbers no derivative is wanted.
template <class T>
using WithOneDerivative = std::conditional_t<std::is_same_v<T, double>, double, OneDerivative>;

/// The quantity itself, by which derivatives are taken.
template <class T>
WithOneDerivative<T> as_variable(const T& quantity) {
  if constexpr (std::is_same_v<T, double>) {
    return quantity;
  } else {
    return OneDerivative(quantity.a, 1);
  }
}

/// A number that depends on `quantity`, with its derivatives by all that `quantity` depends on.
template <class T>
T by_parameters(const WithOneDerivative<T>& x, const T& quantity) {
  if constexpr (std::is_same_v<T, double>) {
    return x;
  } else {
    return x.a + x.v * (quantity - quantity.a);
  }
}

}  // namespace tribofit::detail
