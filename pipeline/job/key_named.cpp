#include "pipeline/job/key_named.h"

#include <algorithm>

#include "pipeline/job/job_keys.h"

namespace meshwind {

std::string job_key_named(std::string_view word) {
    std::string name(word.substr(std::min(word.find_first_not_of('-'), word.size())));
    std::replace(name.begin(), name.end(), '-', '_');
    const KeyTable<Job>& table = job_keys();
    for (const Key<Job>& key : table.keys) {
        if (name == key.name) {
            return name;
        }
        const bool ahead = name.size() > key.name.size() && name.starts_with(key.name) &&
                           name[key.name.size()] == '_';
        const auto within = key.schema.find("properties");
        if (ahead && within != key.schema.end() &&
            within->contains(name.substr(key.name.size() + 1))) {
            return name.replace(key.name.size(), 1, ".");
        }
    }
    return name.empty() ? name : key_below(table, name);
}

}  // namespace meshwind
