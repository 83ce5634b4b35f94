#pragma once

#include <iterator>
#include <utility>

#include "core/model/result.h"

namespace ctpm {

/// Adds further errors to those that were found before.
inline void append(Errors& all, Errors more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Adds the errors of a Result, if it holds any.
template <class T>
void append(Errors& all, const Result<T>& result) {
  if (!result) append(all, result.errors());
}

}  // namespace ctpm
