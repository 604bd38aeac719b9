#pragma once
// Elementary functions that return the same bits on every machine.

namespace beambench {

/// The standard leaves the last bits of std::sin and similar functions to the library, but a scene
/// must have the same hash everywhere. These functions use only sums and products, and are correct
/// to a few units in the last place for the arguments that occur in scenes (|x| up to a few
/// thousand).
double portable_sin(double radians);
double portable_cos(double radians);
double portable_exp(double x);
double portable_log(double x);  ///< x must be positive

}  // namespace beambench
