#pragma once

#include "machine_options.hpp"
#include "settings.hpp"
#include "tribofit/report/study.hpp"

/// The machine that is studied: identified from the trace of the settings where there is one, with what was typed in
/// place of what was identified; else as typed, what is missing from the published test of the nearest radius.
/// kind: what was typed, for the command that a warning names.
tribofit::StudiedMachine studied_machine(const Settings& settings, const MachineRequest& typed, const Command& kind);

/// Options as typed that say which machine is studied, for the next command.
std::vector<std::string> shared_arguments(const Command& kind);
