#pragma once
// #include <beambench/plugin.hpp>: everything that a plug-in needs.

#include "harness/plugin/plugin.hpp"
