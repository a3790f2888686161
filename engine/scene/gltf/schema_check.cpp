#include "engine/scene/gltf/schema_check.hpp"

#include <heliograph/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace helio::gltf {
namespace {

using nlohmann::json;

/** Elements of the array at a path of the form "a" or "a.b.c"; 0 where there is none. */
std::size_t sizeOf(const Document& document, std::string_view path) {
    if (Document::isList(path)) return document.size(path);
    const json* at = &document.root();
    while (true) {
        const std::size_t dot = path.find('.');
        const std::string key(path.substr(0, dot));
        if (!at->is_object()) return 0;
        const auto found = at->find(key);
        if (found == at->end()) return 0;
        at = &*found;
        if (dot == std::string_view::npos) return at->is_array() ? at->size() : 0;
        path.remove_prefix(dot + 1);
    }
}

/** A value as it stands in the file, kept short. */
std::string shown(const json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array";
    if (value.is_string()) return fmt::format("'{}'", value.get_ref<const std::string&>().substr(0, 40));
    return value.dump();
}

}  // namespace

std::string Place::text() const {
    if (parent == nullptr) return {};
    const std::string before = parent->text();
    if (key == nullptr) return fmt::format("{}[{}]", before, index);
    return before.empty() ? key : before + "." + key;
}

void refuse(const Context& context, const Place& place, const std::string& fault, const std::string& remedy) {
    throw InputError(context.file, place.text(), fault, remedy);
}

Check string() {
    return [](const Context& context, const Place& place, const json& value) {
        if (!value.is_string()) refuse(context, place, "is " + shown(value), "give a string");
    };
}

Check boolean() {
    return [](const Context& context, const Place& place, const json& value) {
        if (!value.is_boolean()) refuse(context, place, "is " + shown(value), "give true or false");
    };
}

Check oneOf(std::vector<std::string> values) {
    return [values = std::move(values)](const Context& context, const Place& place, const json& value) {
        if (value.is_string() && std::find(values.begin(), values.end(), value) != values.end()) return;
        refuse(context, place, "is " + shown(value), fmt::format("give one of {}", fmt::join(values, ", ")));
    };
}

Check oneOf(std::vector<int> values) {
    return [values = std::move(values)](const Context& context, const Place& place, const json& value) {
        if (value.is_number() && std::find(values.begin(), values.end(), value.get<double>()) != values.end())
            return;
        refuse(context, place, "is " + shown(value), fmt::format("give one of {}", fmt::join(values, ", ")));
    };
}

Check number(double low, double high) {
    return [low, high](const Context& context, const Place& place, const json& value) {
        if (!value.is_number()) refuse(context, place, "is " + shown(value), "give a number");
        const double x = value.get<double>();
        if (!(x >= low && x <= high)) {
            refuse(context, place, fmt::format("is {}", x),
                   fmt::format("give a number from {} to {}", low, high));
        }
    };
}

Check positive() {
    return [](const Context& context, const Place& place, const json& value) {
        if (!value.is_number()) refuse(context, place, "is " + shown(value), "give a number");
        const auto x = float(value.get<double>());
        if (!(x > 0) || std::isinf(x))
            refuse(context, place, "is " + shown(value), "give a number above 0 that single precision holds");
    };
}

Check integer(double low, double high) {
    return [low, high](const Context& context, const Place& place, const json& value) {
        const double x = value.is_number() ? value.get<double>() : NAN;
        if (x >= low && x <= high && x == std::floor(x)) return;
        refuse(context, place, "is " + shown(value), fmt::format("give an integer from {} to {}", low, high));
    };
}

Check indexInto(const char* array) {
    return [array](const Context& context, const Place& place, const json& value) {
        const std::size_t size = sizeOf(context.document, array);
        const double x = value.is_number() ? value.get<double>() : NAN;
        if (x >= 0 && x < double(size) && x == std::floor(x)) return;
        refuse(context, place, fmt::format("is {}, no index into {}", shown(value), array),
               size == 0 ? fmt::format("the file has no {}", array)
                         : fmt::format("give an integer from 0 to {}", size - 1));
    };
}

Check arrayOf(Check element, std::size_t minimum, std::size_t maximum) {
    return [=, element = std::move(element)](const Context& context, const Place& place, const json& value) {
        if (!value.is_array()) refuse(context, place, "is " + shown(value), "give an array");
        if (value.size() < minimum || value.size() > maximum) {
            refuse(context, place, fmt::format("has {} elements", value.size()),
                   minimum == maximum ? fmt::format("give {}", minimum)
                                      : fmt::format("give at least {}", minimum));
        }
        for (std::size_t i = 0; i < value.size(); ++i) element(context, Place{&place, nullptr, i}, value[i]);
    };
}

Check object(std::vector<Property> properties) {
    return
        [properties = std::move(properties)](const Context& context, const Place& place, const json& value) {
            if (!value.is_object()) refuse(context, place, "is " + shown(value), "give an object");
            for (const Property& property : properties) {
                const auto member = value.find(property.name);
                if (member != value.end()) {
                    property.check(context, Place{&place, property.name, 0}, *member);
                } else if (property.isRequired) {
                    refuse(context, place, fmt::format("has no {}", property.name),
                           fmt::format("glTF 2.0 requires {}", property.name));
                }
            }
        };
}

Check mapOf(Check value) {
    return [value = std::move(value)](const Context& context, const Place& place, const json& map) {
        if (!map.is_object()) refuse(context, place, "is " + shown(map), "give an object");
        for (const auto& [key, member] : map.items()) value(context, Place{&place, key.c_str(), 0}, member);
    };
}

}  // namespace helio::gltf
