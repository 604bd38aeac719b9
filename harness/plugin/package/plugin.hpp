#pragma once
// #include <beambench/plugin.hpp>: all that a plug-in needs.

#include "harness/plugin/plugin.hpp"
