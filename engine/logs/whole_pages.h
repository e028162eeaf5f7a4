#pragma once

#include <filesystem>

namespace surefield {

/// The name of SQLite's way to files under which a database that was cut off ends after its last whole page.
/// SQLite itself takes a part of a page for one that ends in zeros, and with it a message that it never held.
/// Null for a database whose pages are all whole, which needs none.
const char* whole_pages_vfs(const std::filesystem::path& file);

}  // namespace surefield
