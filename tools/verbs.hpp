#pragma once

#include "command.hpp"

/// Each verb adds its options and what it runs. It may throw UsageError and tribofit::InputError, which main() prints.
void add_identify(const Command& app);
void add_columns(const Command& app);
void add_manifest(const Command& app);
void add_merge(const Command& app);
void add_diagnose(const Command& app);
void add_plan(const Command& app);
void add_explore(const Command& app);
void add_rig(const Command& app);
void add_twin(const Command& app);
void add_effects(const Command& app);
void add_cite(const Command& app);
void add_simulate(const Command& app);
void add_study(const Command& app);
void add_help(const Command& app);
void add_completion(const Command& app);
