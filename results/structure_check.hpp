#pragma once

#include <filesystem>

namespace frahm::results {

// Walks through a file that may be damaged or made to do harm, within bounds, and reads its attributes and
// small datasets, and follows their scales. Throws StoreError, naming the object, for what no result has:
// links that lead elsewhere (soft, external), data in other files (external storage, virtual datasets),
// datasets without an extent, of more than 2^40 values or in chunks above 2 GiB, texts above 64 MiB, groups
// nested deeper than 8 (as where one contains itself), more than 100,000 objects.
void check_structure(const std::filesystem::path& path);

}  // namespace frahm::results
