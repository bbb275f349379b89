#pragma once

#include <fmt/ostream.h>
#include <fmt/ranges.h>

// libfmt's headers define the printing to streams and of ranges as a template. Every source that prints
// would compile the template again: two to three seconds each. Precompiled headers contain this declaration,
// so the template is compiled once, in format_once.cpp; no source needs to include this file.
#if FMT_VERSION / 10000 == 9
extern template void fmt::detail::vformat_to<char>(fmt::detail::buffer<char>&, fmt::string_view,
                                                   fmt::format_args, fmt::detail::locale_ref);
#endif
