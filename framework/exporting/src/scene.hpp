// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_EXPORTING_SCENE_HPP_
#define KOMPONO_EXPORTING_SCENE_HPP_

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kompono/kinematics/machine.hpp"

namespace kompono::exporting {

/// One thing to be drawn, in the frame of the workpiece-side base.
struct Shape {
  enum class Form {
    kLine,   ///< through its points
    kBody,   ///< the outline of its points, filled
    kDot,    ///< a circle at its point
    kArrow,  ///< from the first point to the second, both ways, with the text at its head
    kArc,    ///< about the direction from the first point to the second, with the text beside it
    kName,   ///< the text beside its point
  } form = Form::kLine;
  std::string kind;  ///< class of the element in the picture
  std::vector<Eigen::Vector3d> points;
  std::string text;
  int layer = 0;  ///< later layers lie over earlier ones; within one the depth decides
};

/// Everything of a machine, all branches of its formula together.
struct Scene {
  std::vector<Shape> shapes;
  std::vector<Eigen::Vector3d> joints;  ///< points of the skeletons; what tells a planar machine
  double size_mm = 1.0;                 ///< of the whole
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: right, back and up
};

[[nodiscard]] Scene SceneOf(const kinematics::Machine& machine,
                            const kinematics::VectorXd& z,
                            const kinematics::VectorXd& theta);

}  // namespace kompono::exporting

#endif  // KOMPONO_EXPORTING_SCENE_HPP_
