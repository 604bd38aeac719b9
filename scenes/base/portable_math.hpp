#pragma once
// Elementary functions that give the same bits on every machine.

namespace beambench {

/// The standard leaves the last bits of std::sin and its kind to the library, and a scene must have
/// one hash everywhere. These are sums and products alone, correct to a few units in the last place
/// for the arguments that scenes have (|x| up to some thousands).
double portable_sin(double radians);
double portable_cos(double radians);
double portable_exp(double x);
double portable_log(double x);  ///< of a positive number

}  // namespace beambench
