#pragma once
/** @file Small checks that compose into a schema for a JSON document. */
#include "engine/scene/gltf/json_reader.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace helio::gltf {

/** Where a value is in the document, as a chain that is only spelt out for an error. */
struct Place {
    const Place* parent = nullptr;
    const char* key = nullptr;  ///< nullptr: an array's element
    std::size_t index = 0;
    std::string text() const;
};

struct Context {
    const std::string& file;
    const Document& document;
};

using Check = std::function<void(const Context&, const Place&, const nlohmann::json&)>;

struct Property {
    const char* name;
    Check check;
    bool isRequired = false;
};

/** Throws the InputError of a value that is not `expected`. */
[[noreturn]] void refuse(const Context& context, const Place& place, const std::string& fault,
                         const std::string& remedy);

Check string();
Check boolean();
Check oneOf(std::vector<std::string> values);
/** A finite number in [low, high] that single precision can hold. */
Check number(double low = -3.4e38, double high = 3.4e38);
/** A number above 0. */
Check positive();
Check integer(double low, double high);
Check oneOf(std::vector<int> values);
/** An index into one of the document's arrays, named by its path, e.g. "accessors". */
Check indexInto(const char* array);
Check arrayOf(Check element, std::size_t minimum = 0, std::size_t maximum = std::size_t(-1));
/** An object with these members among others; each listed one is checked where it is there. */
Check object(std::vector<Property> properties);
/** An object all of whose members pass one check. */
Check mapOf(Check value);

}  // namespace helio::gltf
