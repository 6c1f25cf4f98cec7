#pragma once

#include <string>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::drivers::sensor {

/// Returns the value of an environment variable. Fails if it is not set, or empty. Thread-safe: as long as nobody
/// changes the environment.
Result<Secret, Failure> secret_in_environment(const std::string& variable);

/// The secret of a driver's parameters NAME (itself), NAME_file and NAME_env (its place), of which at most one is
/// given; empty: none is. Throws std::runtime_error, naming the parameter, if it cannot be read.
Secret secret_of(const ParameterValues& values, const std::string& name);

}  // namespace yuragi::drivers::sensor
