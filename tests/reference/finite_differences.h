#pragma once

namespace surefield::reference {

/// df/dx by central differences of fourth order with step `h`. `f` reads the variable that `x` refers to,
/// which is restored afterwards. Values may be numbers or Eigen arrays.
template <class Function>
auto central_difference(const Function& f, double& x, double h) {
  const double centre = x;
  const auto at = [&](double offset) {
    x = centre + offset;
    return f();
  };
  auto derivative = at(h);
  derivative -= at(-h);
  derivative *= 8;
  derivative -= at(2 * h);
  derivative += at(-2 * h);
  derivative /= 12 * h;
  x = centre;
  return derivative;
}

}  // namespace surefield::reference
