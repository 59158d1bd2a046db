#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

/// Each verb adds its options to `app` and leaves the exit status of its run in `status`.
/// A verb may throw tribofit::InputError; main() prints it.
void add_identify(CLI::App& app, int& status);
void add_manifest(CLI::App& app, int& status);
void add_merge(CLI::App& app, int& status);
void add_diagnose(CLI::App& app, int& status);
void add_explore(CLI::App& app, int& status);
void add_rig(CLI::App& app, int& status);
void add_twin(CLI::App& app, int& status);
void add_effects(CLI::App& app, int& status);
void add_simulate(CLI::App& app, int& status);
void add_study(CLI::App& app, int& status);
