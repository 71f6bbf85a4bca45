// SPDX-License-Identifier: Apache-2.0
#ifndef KOMPONO_CLI_ASSEMBLY_MODES_HPP_
#define KOMPONO_CLI_ASSEMBLY_MODES_HPP_

#include "exit_code.hpp"
#include "session.hpp"

#include "kompono/kinematics/machine.hpp"

namespace kompono::cli {

/// kompono solve --drives … --all: every way in which the machine can stand.
ExitCode ShowAssemblyModes(Session& session,
                           const kinematics::Machine& machine,
                           const Eigen::VectorXd& readings,
                           layout::RotationOrder order);

}  // namespace kompono::cli

#endif  // KOMPONO_CLI_ASSEMBLY_MODES_HPP_
