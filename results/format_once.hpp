#pragma once

#include <fmt/ostream.h>
#include <fmt/ranges.h>

// What prints numbers into a stream or a range is a template that libfmt's headers define, and every source
// that prints would compile it anew: two to three seconds each. Sources with precompiled headers find it
// declared here as compiled once, in format_once.cpp; no source needs to include this.
#if FMT_VERSION / 10000 == 9
extern template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&, fmt::string_view,
                                                   fmt::format_args, fmt::detail::locale_ref);
#endif
