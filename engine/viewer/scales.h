#pragma once

#include <string>
#include <vector>

namespace surefield {

/// The largest of 1, 2 and 5 times a power of ten that is not above `most`, which is finite and positive: the
/// length of a scale bar.
double round_below(double most);

/// The multiples of a step of 1, 2 or 5 times a power of ten that lie between `low` and `high`, ascending: as
/// many as there may be, up to `most` (at least 2). None where `low` is not below `high`.
std::vector<double> ticks_between(double low, double high, int most);

/// A length as people say it, to three digits: "0.4 mm", "12.3 cm", "1.23 m", "120 m".
std::string format_length(double metres);

/// A length of a scale bar, without digits that say nothing: "5 mm", "20 cm", "2 m".
std::string format_round_length(double metres);

/// A time as people say it: "7.25 s", "1:07.3", "1:02:07".
std::string format_time(double seconds);

}  // namespace surefield
