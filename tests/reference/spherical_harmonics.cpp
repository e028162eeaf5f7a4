#include "tests/reference/spherical_harmonics.h"

namespace surefield::reference {

namespace {

constexpr double c0 = 0.28209479177387814;
constexpr double c1 = 0.4886025119029199;
constexpr double c2[] = {1.0925484305920792, -1.0925484305920792, 0.31539156525252005, -1.0925484305920792,
                         0.5462742152960396};
constexpr double c3[] = {-0.5900435899266435, 2.890611442640554, -0.4570457994644658, 0.3731763325901154,
                         -0.4570457994644658, 1.445305721320277, -0.5900435899266435};

}  // namespace

Eigen::Matrix<double, 16, 1> sh_basis(const Eigen::Vector3d& direction) {
  const double x = direction.x(), y = direction.y(), z = direction.z();
  const double xx = x * x, yy = y * y, zz = z * z;
  Eigen::Matrix<double, 16, 1> basis;
  basis << c0,                                 //
      -c1 * y,                                 //
      c1 * z,                                  //
      -c1 * x,                                 //
      c2[0] * x * y,                           //
      c2[1] * y * z,                           //
      c2[2] * (2 * zz - xx - yy),              //
      c2[3] * x * z,                           //
      c2[4] * (xx - yy),                       //
      c3[0] * y * (3 * xx - yy),               //
      c3[1] * x * y * z,                       //
      c3[2] * y * (4 * zz - xx - yy),          //
      c3[3] * z * (2 * zz - 3 * xx - 3 * yy),  //
      c3[4] * x * (4 * zz - xx - yy),          //
      c3[5] * z * (xx - yy),                   //
      c3[6] * x * (xx - 3 * yy);
  return basis;
}

Eigen::Matrix<double, 16, 3> sh_basis_gradient(const Eigen::Vector3d& direction) {
  const double x = direction.x(), y = direction.y(), z = direction.z();
  const double xx = x * x, yy = y * y, zz = z * z;
  Eigen::Matrix<double, 16, 3> gradient;
  gradient << 0, 0, 0,                                                         //
      0, -c1, 0,                                                               //
      0, 0, c1,                                                                //
      -c1, 0, 0,                                                               //
      c2[0] * y, c2[0] * x, 0,                                                 //
      0, c2[1] * z, c2[1] * y,                                                 //
      -2 * c2[2] * x, -2 * c2[2] * y, 4 * c2[2] * z,                           //
      c2[3] * z, 0, c2[3] * x,                                                 //
      2 * c2[4] * x, -2 * c2[4] * y, 0,                                        //
      6 * c3[0] * x * y, 3 * c3[0] * (xx - yy), 0,                             //
      c3[1] * y * z, c3[1] * x * z, c3[1] * x * y,                             //
      -2 * c3[2] * x * y, c3[2] * (4 * zz - xx - 3 * yy), 8 * c3[2] * y * z,   //
      -6 * c3[3] * x * z, -6 * c3[3] * y * z, 3 * c3[3] * (2 * zz - xx - yy),  //
      c3[4] * (4 * zz - 3 * xx - yy), -2 * c3[4] * x * y, 8 * c3[4] * x * z,   //
      2 * c3[5] * x * z, -2 * c3[5] * y * z, c3[5] * (xx - yy),                //
      3 * c3[6] * (xx - yy), -6 * c3[6] * x * y, 0;
  return gradient;
}

}  // namespace surefield::reference
