#pragma once
/** @file The schema of extras.heliograph, and what it says of a document. */
#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace helio::extras {

/** The installed file's text, as JSON. */
const nlohmann::json& schema();

struct Fault {
    std::string pointer;  ///< JSON pointer into what was checked
    std::string fault;
    std::string expected;  ///< the schema's own description of what belongs there
};

/** The first and deepest fault of an object {KIND: extras}; nothing where the schema accepts it. */
std::optional<Fault> faultOf(const nlohmann::json& extras);

}  // namespace helio::extras
