#pragma once

#include <string>

// What a power failure would leave: copies of what was last synced.
//
//   FAULT_SYNCED  a folder outside the one that is watched; without it nothing is kept

// Called when a descriptor has been synced. Of a file keeps its bytes, as <inode>; of a folder the names in
// it, each on a line of `names` behind the inode that it stands for.
void keep_synced(int descriptor, const std::string& path);
