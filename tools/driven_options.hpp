#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "settings.hpp"
#include "tribofit/fit/rate_state.hpp"
#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/record_kind.hpp"

/// Whether --speed states those of a load point by time.
bool names_load_point_speeds(const Settings& s);

/// "0s:2um/s,60s:10um/s": speeds from times on. `option`: for messages.
std::vector<tribofit::LoadPointPhase> phases_from(const std::string& text, const std::string& option);

/// Speeds of the load point as --speed states them; none where it does not. Usage error: one speed alone.
std::vector<tribofit::LoadPointPhase> load_point_from(const Settings& s, std::optional<tribofit::RecordKind> kind);

/// --reference-speed, v0.
double reference_speed_from(const std::string& text);

/// How velocity steps and holds are fitted. fitted: values given of the laws, whose names are theirs where --kind and
/// --speed leave the kind to the file.
tribofit::RateStateOptions driven_options_from(const Settings& s, const std::vector<tribofit::GivenParameter>& fitted);

/// Whether --start or --bounds may name it: for such a record, which --kind, --speed or the file says it is.
bool is_rate_state_parameter(const Settings& s, const std::string& name);

/// "a=0.01,b=0.014,D_c=10um,k=0.002/um" by names, SI. Usage error for others.
std::map<std::string, double> rate_state_values(const std::string& text, const std::string& option);
