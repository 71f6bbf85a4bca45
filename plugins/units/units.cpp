// SPDX-License-Identifier: Apache-2.0
// Units that close a chain: what holds the workpiece, what carries the tools. Equations: README.md.
#include "holders.hpp"
#include "tools.hpp"
#include "turrets.hpp"

KOMPONO_PLUGIN("org.kompono.units",
               "0.1.0",
               KOMPONO_MODULE("workpiece", kompono::units::Workpiece),
               KOMPONO_MODULE("sheet_drive", kompono::units::SheetDrive),
               KOMPONO_MODULE("headstock", kompono::units::Headstock),
               KOMPONO_MODULE("counter_spindle", kompono::units::CounterSpindle),
               KOMPONO_MODULE("tailstock", kompono::units::Tailstock),
               KOMPONO_MODULE("spindle", kompono::units::Spindle),
               KOMPONO_MODULE("tool", kompono::units::Tool),
               KOMPONO_MODULE("turret", kompono::units::Turret),
               KOMPONO_MODULE("twin_turret", kompono::units::TwinTurret),
               KOMPONO_MODULE("jet_head", kompono::units::JetHead))
