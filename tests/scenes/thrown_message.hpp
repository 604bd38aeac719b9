#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "scenes/base/error.hpp"

namespace beambench::scenes {

/// Returns the message of the InputError that the call throws, or "(nothing thrown)".
template <typename Call>
std::string thrown_message(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

/// Returns whether the message contains each of the words.
inline ::testing::AssertionResult says(std::string_view message,
                                       std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    if (message.find(word) == std::string_view::npos) {
      return ::testing::AssertionFailure() << "no '" << word << "' in: " << message;
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace beambench::scenes
