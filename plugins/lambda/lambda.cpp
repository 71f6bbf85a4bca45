// SPDX-License-Identifier: Apache-2.0
// Lambda: link 1 from slider 1 to the tool point, link 2 from slider 2 to a joint on link 1 (SO eq.
// 56-61, corrected as in the project's list of corrections). Equations: README.md.
#include <kompono/sdk/mechanism.hpp>

namespace {

using kompono::Vector3;

class Lambda final : public kompono::sdk::AutodiffMechanism<Lambda> {
 public:
  static constexpr kompono::sdk::MechanismSpec kSpec{
      .letters = "XY", .drives = 2, .parameters = 3, .modes = 3, .closures = 2, .points = 4};

  /// q1 = x - m1 sqrt(L1² - y²);  q2 = q1 + m1 L3 c + m2 sqrt(L2² - (L3 y / L1)²), c = sqrt(1 - (y
  /// / L1)²)
  template <class T>
  void Drives(const Arguments<T>& in, DriveValues<T> out) const {
    using std::sqrt;
    const T ratio = in.parameter[kL3] / in.parameter[kL1];
    const T joint_y = ratio * in.x[1];
    out.reach[0] = in.parameter[kL1] * in.parameter[kL1] - in.x[1] * in.x[1];
    out.reach[1] = in.parameter[kL2] * in.parameter[kL2] - joint_y * joint_y;
    const T link1_x = in.mode[kLink1] * sqrt(out.reach[0]);
    out.q[0] = in.x[0] - link1_x;
    out.q[1] = out.q[0] + ratio * link1_x + in.mode[kLink2] * sqrt(out.reach[1]);
  }

  template <class T>
  void Closure(const Arguments<T>& in, std::span<T> g) const {
    const T ratio = in.parameter[kL3] / in.parameter[kL1];
    const T link1_x = in.x[0] - in.q[0];
    const T link2_x = in.q[0] + ratio * link1_x - in.q[1];
    const T joint_y = ratio * in.x[1];
    g[0] = link1_x * link1_x + in.x[1] * in.x[1] - in.parameter[kL1] * in.parameter[kL1];
    g[1] = link2_x * link2_x + joint_y * joint_y - in.parameter[kL2] * in.parameter[kL2];
  }

  /// The triangle slider 1, joint, slider 2 has the sides L3, L2 and q2 - q1.
  template <class T>
  void Coordinates(const Arguments<T>& in, std::span<T> x) const {
    using std::sqrt;
    const T base = in.q[1] - in.q[0];
    const T l2 = in.parameter[kL2];
    const T l3 = in.parameter[kL3];
    const T joint_x = base / T(2.0) + (l3 * l3 - l2 * l2) / (T(2.0) * base);
    const T joint_y = in.mode[kSide] * sqrt(l3 * l3 - joint_x * joint_x);
    const T ratio = in.parameter[kL1] / l3;
    x[0] = in.q[0] + ratio * joint_x;
    x[1] = ratio * joint_y;
  }

  template <class T>
  void Home(const Arguments<T>& in, std::span<T> x) const {
    const T l1 = in.parameter[kL1];
    const T other = l1 * in.parameter[kL2] / in.parameter[kL3];
    x[0] = T(0.0);
    x[1] = in.mode[kSide] * T(0.5) * kompono::Select(kompono::Less(l1, other), l1, other);
  }

  template <class T>
  void Skeleton(const Arguments<T>& in, std::span<Vector3<T>> point) const {
    const T ratio = in.parameter[kL3] / in.parameter[kL1];
    point[0] = {in.q[0], T(0.0), T(0.0)};
    point[1] = {in.q[1], T(0.0), T(0.0)};
    point[2] = {in.q[0] + ratio * (in.x[0] - in.q[0]), ratio * in.x[1], T(0.0)};
    point[3] = {in.x[0], in.x[1], T(0.0)};
  }

 private:
  enum Parameter : std::size_t { kL1, kL2, kL3 };
  enum Mode : std::size_t { kLink1, kLink2, kSide };
};

}  // namespace

KOMPONO_PLUGIN("org.kompono.lambda", "0.1.0", KOMPONO_MODULE("lambda", Lambda))
